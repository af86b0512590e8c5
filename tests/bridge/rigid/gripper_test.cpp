// Two fingers, of a robot or led by a program, that hold a towel by friction alone.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/bridge/rigid/multibody_scene.hpp"
#include "tests/bridge/rigid/towel.hpp"
#include "tests/support/count.hpp"

namespace weft::bridge {
namespace {

/// A carriage that a motor lifts, with two fingers on sliders: one that stands and one that presses.
class Gripper {
 public:
  Gripper(RobotWorld& world, double force) {
    const btVector3 pad(btScalar(0.02), btScalar(0.03), btScalar(0.12));
    const btVector3 inertia(btScalar(0.001), btScalar(0.001), btScalar(0.001));
    const btQuaternion none = btQuaternion::getIdentity();
    robot_ = &world.add_robot(3, 0, btVector3(0, 0, 0), btVector3(0, 1, 0));
    robot_->setHasSelfCollision(true);
    robot_->setupPrismatic(0, 1, inertia, -1, none, btVector3(0, 1, 0),
                           btVector3(0, btScalar(-0.92), 0), btVector3(0, 0, 0), true);
    robot_->setupPrismatic(1, btScalar(0.2), inertia, 0, none, btVector3(1, 0, 0),
                           btVector3(btScalar(-0.05), btScalar(-0.1), 0), btVector3(0, 0, 0), true);
    robot_->setupPrismatic(2, btScalar(0.2), inertia, 0, none, btVector3(1, 0, 0),
                           btVector3(btScalar(0.05), btScalar(-0.1), 0), btVector3(0, 0, 0), true);
    world.finish(*robot_);
    // Bullet leaves out motors of links without a collider.
    world.add_collider(*robot_, 0, btVector3(btScalar(0.1), btScalar(0.01), btScalar(0.01)));
    left_ = &world.add_collider(*robot_, 1, pad);
    right_ = &world.add_collider(*robot_, 2, pad);
    lift_ = &world.add_motor(*robot_, 0, 0, 1000);
    stand_ = &world.add_motor(*robot_, 1, 0.1, 1000);
    press_ = &world.add_motor(*robot_, 2, -0.1, force);
  }
  void stand() { stand_->setVelocityTarget(0); }
  void lift(double speed) { lift_->setVelocityTarget(static_cast<btScalar>(speed)); }
  void open() {
    stand_->setVelocityTarget(btScalar(-0.2));
    press_->setVelocityTarget(btScalar(0.2));
    press_->setMaxAppliedImpulse(btScalar(100));
  }
  /// The force of the lift [N].
  [[nodiscard]] double load() const {
    return std::abs(static_cast<double>(lift_->getAppliedImpulse(0))) / RobotWorld::kStep;
  }
  [[nodiscard]] double height() const {
    return static_cast<double>(left_->getWorldTransform().getOrigin().y());
  }
  [[nodiscard]] double left() const {
    return static_cast<double>(left_->getWorldTransform().getOrigin().x());
  }

 private:
  btMultiBody* robot_;
  btMultiBodyLinkCollider* left_;
  btMultiBodyLinkCollider* right_;
  btMultiBodyJointMotor* lift_;
  btMultiBodyJointMotor* stand_;
  btMultiBodyJointMotor* press_;
};

struct Outcome {
  double lifted;   ///< [m] that the gripper has gone up
  double carried;  ///< [m] that the held node has gone up with it
  double load;     ///< [N] on the lift, mean while it stands
  double slip;     ///< [m] of the held node after that, in the time that was asked for
  double fallen;   ///< [m] in half a second after the fingers have opened
};

Outcome hold(double force, double seconds, unsigned seed, double stiffness) {
  RobotWorld world;
  const ClothMesh mesh = towel(seed);
  btSoftBody& body = world.add_cloth(
      mesh, {law("tension", "stiffness", stiffness), law("velocity_damping", "rate", 2)},
      kTowelFriction, kTowelMargin);
  std::vector<btScalar> inverse_masses;
  for (const int corner : top_corners(mesh)) {
    inverse_masses.push_back(body.m_nodes[corner].m_im);
    body.m_nodes[corner].m_im = 0;
  }
  EXPECT_EQ(inverse_masses.size(), 2U);
  Gripper gripper(world, force);
  const int held = middle(mesh);
  const auto height = [&] { return static_cast<double>(body.m_nodes[held].m_x.y()); };
  for (int step = 0; step < 60; ++step) {
    if (gripper.left() > -0.0201) gripper.stand();
    world.step();
  }
  // Slowly: a load that comes at once would be twice as heavy.
  for (int step = 0; step < 60; ++step) {
    for (const int corner : top_corners(mesh)) {
      body.m_nodes[corner].m_x += btVector3(0, btScalar(-5e-5), 0);
    }
    world.step();
  }
  std::size_t next = 0;
  for (const int corner : top_corners(mesh)) body.m_nodes[corner].m_im = inverse_masses[next++];
  Outcome outcome{};
  const double start = height();
  const double gripper_start = gripper.height();
  // A tenth of g is what the grip can bear.
  for (int step = 0; step < 60; ++step) {
    gripper.lift(std::min(0.2, std::min(step, 59 - step) * RobotWorld::kStep));
    world.step();
  }
  gripper.lift(0);
  world.step(30);
  outcome.carried = height() - start;
  outcome.lifted = gripper.height() - gripper_start;
  const double offset = height() - gripper.height();
  const int num_steps = static_cast<int>(seconds / RobotWorld::kStep);
  for (int step = 0; step < num_steps; ++step) {
    world.step();
    outcome.load += gripper.load() / num_steps;
  }
  outcome.slip = std::abs(height() - gripper.height() - offset);
  const double before = height();
  gripper.open();
  world.step(30);
  outcome.fallen = before - height();
  EXPECT_FALSE(world.solver().blow_up(body));
  return outcome;
}

TEST(Gripper, HoldsATowelAboveTheThresholdOfFriction) {
  for (const double stiffness : kTowelStiffness) {
    for (int seed = 1; seed <= test::count(1); ++seed) {
      const Outcome outcome = hold(1.25 * kGripThreshold, 10, seed, stiffness);
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << stiffness << " N/m");
      EXPECT_LT(outcome.slip, 1e-3);
      EXPECT_GT(outcome.lifted, 0.15);
      EXPECT_NEAR(outcome.carried, outcome.lifted, 5e-3);
      EXPECT_GT(outcome.fallen, 0.3);
      EXPECT_NEAR(outcome.load, 9.81 * (1.4 + kTowelMass), 0.05);
    }
  }
}

TEST(Gripper, ATowelSlipsBelowTheThreshold) {
  for (const double stiffness : kTowelStiffness) {
    for (int seed = 1; seed <= test::count(1); ++seed) {
      const Outcome outcome = hold(0.9 * kGripThreshold, 1, seed, stiffness);
      EXPECT_LT(outcome.carried, outcome.lifted - 0.1) << seed << ", " << stiffness << " N/m";
    }
  }
}

// Fingers that the program leads have no force: they hold what they pinch.
TEST(Gripper, KinematicFingersCarryATowelAndLetItGo) {
  RobotWorld world;
  const ClothMesh mesh = towel(1);
  btSoftBody& body =
      world.add_cloth(mesh, {law("tension", "stiffness", 2000), law("velocity_damping", "rate", 2)},
                      kTowelFriction, kTowelMargin);
  const btVector3 pad(btScalar(0.02), btScalar(0.03), btScalar(0.12));
  std::array<btRigidBody*, 2> fingers{};
  for (std::size_t k = 0; k < 2; ++k) {
    fingers[k] = &world.add_box(pad, 0, vector(k == 0 ? -0.05 : 0.05, -0.02, 0));
    fingers[k]->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  }
  const auto lead = [&](double gap, double sideways, double up) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double x = (k == 0 ? -1 : 1) * (0.02 + gap / 2);
      fingers[k]->setWorldTransform(at(x, -0.02 + up, sideways));
    }
    world.step();
  };
  const std::vector<int> corners = top_corners(mesh);
  std::vector<btScalar> inverse_masses;
  for (const int corner : corners) {
    inverse_masses.push_back(body.m_nodes[corner].m_im);
    body.m_nodes[corner].m_im = 0;
  }
  for (int step = 0; step < 30; ++step) lead(0.06 - 0.002 * step, 0, 0);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    body.m_nodes[corners[k]].m_im = inverse_masses[k];
  }
  const int held = middle(mesh);
  const btVector3 start = body.m_nodes[held].m_x;
  for (int step = 1; step <= 60; ++step) lead(0, 0, 0.2 * step / 60);
  for (int step = 1; step <= 60; ++step) lead(0, 0.3 * step / 60, 0.2);
  const btVector3 carried = body.m_nodes[held].m_x - start;
  EXPECT_NEAR(static_cast<double>(carried.y()), 0.2, 1e-3);
  EXPECT_NEAR(static_cast<double>(carried.z()), 0.3, 1e-3);
  for (int step = 0; step < 600; ++step) lead(0, 0.3, 0.2);
  EXPECT_LT((body.m_nodes[held].m_x - start - carried).length(), 1e-3);
  for (int step = 0; step < 30; ++step) lead(0.004 * step, 0.3, 0.2);
  EXPECT_LT(body.m_nodes[held].m_x.y(), start.y() - btScalar(0.1));
  EXPECT_FALSE(world.solver().blow_up(body));
}

}  // namespace
}  // namespace weft::bridge
