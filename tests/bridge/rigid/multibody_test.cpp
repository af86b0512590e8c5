// Links of multibodies and fast cloth: each moves the other.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <weft/bridge/rigid/multibody_inertia.hpp>

#include "tests/bridge/fast_scene.hpp"
#include "tests/bridge/rigid/multibody_scene.hpp"

namespace weft::bridge {
namespace {

btVector3 box_inertia(double mass, const btVector3& half) {
  btVector3 inertia;
  btBoxShape(half).calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  return inertia;
}

ClothMesh held_cloth(int n, double size, double mass) {
  ClothMesh mesh = cloth(n, size, 0, mass);
  for (int i = 0; i < n; ++i) {
    for (const int node : {i, n * (n - 1) + i, n * i, n * i + n - 1}) {
      if (std::find(mesh.pinned.begin(), mesh.pinned.end(), node) == mesh.pinned.end()) {
        mesh.pinned.push_back(node);
      }
    }
  }
  return mesh;
}

Vector3<double> momentum_of(const btSoftBody& body) {
  Vector3<double> sum = Vector3<double>::Zero();
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im > 0) sum += from_bullet(node.m_v) / static_cast<double>(node.m_im);
  }
  return sum;
}

Vector3<double> mean_position(const btSoftBody& body) {
  Vector3<double> sum = Vector3<double>::Zero();
  for (int i = 0; i < body.m_nodes.size(); ++i) sum += from_bullet(body.m_nodes[i].m_x);
  return sum / body.m_nodes.size();
}

/// The base of a multibody without joints.
btMultiBody& free_box(RobotWorld& world, double mass, const btVector3& half,
                      const btVector3& place) {
  btMultiBody& robot = world.add_robot(0, mass, box_inertia(mass, half), place);
  world.finish(robot);
  world.add_collider(robot, -1, half);
  return robot;
}

// From low enough: bouncing flat is not stable. What a push of 10 um begins is a tumble after a second, also in steps of 1/240 s
// and in double precision, and from 0.3 m on one box in six walks off the sheet.
TEST(MultiBody, AFreeBoxComesToRestOnATrampoline) {
  RobotWorld world;
  btSoftBody& sheet =
      world.add_cloth(held_cloth(21, 1, 0.2),
                      {law("tension", "stiffness", 200), law("velocity_damping", "rate", 20)});
  const btMultiBody& box =
      free_box(world, 1.0, btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)),
               btVector3(0, btScalar(0.15), 0));
  world.step(1200);
  EXPECT_LT(box.getBasePos().y(), 0.11);
  EXPECT_GT(box.getBasePos().y(), -0.3);
  EXPECT_LT(box.getBaseVel().length(), 2e-3);
  EXPECT_FALSE(world.solver().blow_up(sheet));
}

// The weight of the box is what the sheet's rim bears: as deep as the same rigid body. In damping and steps with which neither
// begins to turn: a box that tumbles comes to rest elsewhere, and after steps of 1/60 s both do.
TEST(MultiBody, AFreeBoxSinksAsDeepAsARigidBody) {
  constexpr double kStep = 1.0 / 240;  // [s]
  constexpr int kNumSteps = 480;
  const auto depth = [](bool is_rigid) {
    RobotWorld world;
    world.add_cloth(held_cloth(21, 1, 0.2),
                    {law("tension", "stiffness", 200), law("velocity_damping", "rate", 400)});
    const btVector3 half(btScalar(0.1), btScalar(0.1), btScalar(0.1));
    const btVector3 place(0, btScalar(0.15), 0);
    if (is_rigid) {
      const btRigidBody& rigid = world.add_box(half, 1.0, place);
      world.step(kNumSteps, kStep);
      return static_cast<double>(rigid.getCenterOfMassPosition().y());
    }
    const btMultiBody& box = free_box(world, 1.0, half, place);
    world.step(kNumSteps, kStep);
    return static_cast<double>(box.getBasePos().y());
  };
  EXPECT_NEAR(depth(false), depth(true), 1e-4);
}

TEST(MultiBody, KeepsMomentumWhenClothMeetsAFreeBox) {
  RobotWorld world(0);
  btSoftBody& sheet = world.add_cloth(cloth(21, 0.8, 0, 0.2), {law("tension", "stiffness", 2000)});
  btMultiBody& box = free_box(world, 0.2, btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)),
                              btVector3(btScalar(0.03), btScalar(0.3), btScalar(0.02)));
  box.setBaseVel(btVector3(0, -5, 0));
  for (int step = 0; step < 20; ++step) {
    world.step();
    const Vector3<double> sum = momentum_of(sheet) + 0.2 * from_bullet(box.getBaseVel());
    EXPECT_NEAR(sum.y(), -1, 1e-4) << step;
    EXPECT_NEAR(sum.x(), 0, 1e-4) << step;
  }
  EXPECT_GT(box.getBaseVel().y(), -4);  // they have met
  EXPECT_LT(momentum_of(sheet).y(), -0.1);
}

// Each of two cloths is solved with half of the box.
TEST(MultiBody, TwoClothsPushOneBoxAndMomentumStays) {
  RobotWorld world(0);
  std::array<btSoftBody*, 2> sheets{};
  for (std::size_t k = 0; k < 2; ++k) {
    ClothMesh mesh = cloth(13, 0.4, 0, 0.1);
    mesh.rest_positions.row(0).array() += k == 0 ? -0.22 : 0.22;
    sheets[k] = &world.add_cloth(mesh, {law("tension", "stiffness", 2000)});
  }
  btMultiBody& box = free_box(world, 0.3, btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.1)),
                              btVector3(0, btScalar(0.25), 0));
  box.setBaseVel(btVector3(0, -3, 0));
  for (int step = 0; step < 20; ++step) {
    world.step();
    const Vector3<double> sum =
        momentum_of(*sheets[0]) + momentum_of(*sheets[1]) + 0.3 * from_bullet(box.getBaseVel());
    EXPECT_NEAR(sum.y(), -0.9, 1e-4) << step;
    EXPECT_NEAR(sum.x(), 0, 1e-4) << step;
  }
  EXPECT_GT(box.getBaseVel().y(), -2.5);  // they have met
  EXPECT_LT(momentum_of(*sheets[0]).y(), -0.05);
  EXPECT_LT(momentum_of(*sheets[1]).y(), -0.05);
}

// A sled: a free base with an arm on a hinge, in flight without gravity. Bullet integrates the arm to first order: turning at
// 3 rad/s the sled alone loses 1.2e-4 kg m/s in a step of 1/60 s, and a sixteenth of that in each of these, at most 6e-4 in all.
// The cloth takes a tenth of all momentum and more.
TEST(MultiBody, KeepsMomentumWhenClothMeetsAnArm) {
  RobotWorld world(0);
  btSoftBody& sheet = world.add_cloth(cloth(21, 0.8, 0, 0.2), {law("tension", "stiffness", 2000)});
  const btVector3 half(btScalar(0.15), btScalar(0.03), btScalar(0.05));
  btMultiBody& robot =
      world.add_robot(1, 0.3, box_inertia(0.3, half), btVector3(0, btScalar(0.3), 0));
  robot.setupRevolute(0, btScalar(0.2), box_inertia(0.2, half), -1, btQuaternion::getIdentity(),
                      btVector3(0, 0, 1), btVector3(btScalar(0.16), 0, 0),
                      btVector3(btScalar(0.16), 0, 0), true);
  world.finish(robot);
  world.add_collider(robot, -1, half);
  world.add_collider(robot, 0, half);
  robot.setBaseVel(btVector3(0, -3, 0));
  const auto momentum = [&] {
    const MultiBodyInertia inertia(robot);
    Vector3<double> sum = momentum_of(sheet);
    sum += 0.3 * from_bullet(robot.getBaseVel());
    sum += 0.2 * from_bullet(link_velocity(robot, 0).linear);
    return sum;
  };
  const Vector3<double> before = momentum();
  double fastest_turn = 0;  // [rad/s]
  for (int step = 0; step < 80; ++step) {
    world.step(1, 1.0 / 240);
    fastest_turn = std::max(fastest_turn, std::abs(static_cast<double>(robot.getJointVel(0))));
    const Vector3<double> now = momentum();
    EXPECT_LT((now - before).norm(), 6e-4) << step;
  }
  EXPECT_LT(momentum_of(sheet).y(), -0.1);
  EXPECT_GT(fastest_turn, 1);  // the cloth has turned the arm
}

// A belt that a joint leads: cloth on it goes along, as friction says.
TEST(MultiBody, ALinkThatMovesCarriesClothByFriction) {
  RobotWorld world;
  const btVector3 half(2, btScalar(0.05), 1);
  btMultiBody& robot = world.add_robot(1, 0, btVector3(0, 0, 0), btVector3(0, -1, 0));
  robot.setupPrismatic(0, 50, box_inertia(50, half), -1, btQuaternion::getIdentity(),
                       btVector3(1, 0, 0), btVector3(0, btScalar(0.94), 0), btVector3(0, 0, 0),
                       true);
  world.finish(robot);
  world.add_collider(robot, 0, half);
  btMultiBodyJointMotor& motor = world.add_motor(robot, 0, 0, 5000);
  btSoftBody& sheet =
      world.add_cloth(cloth(13, 0.4, 0.011, 0.1), {law("tension", "stiffness", 500)}, 0.6);
  world.step(30);
  const double start = mean_position(sheet).x() - static_cast<double>(robot.getJointPos(0));
  motor.setVelocityTarget(btScalar(0.5));
  world.step(60);
  EXPECT_NEAR(momentum_of(sheet).x() / 0.1, 0.5, 0.01);
  motor.setVelocityTarget(btScalar(0));
  world.step(60);
  EXPECT_GT(robot.getJointPos(0), 0.4);
  const double slip = mean_position(sheet).x() - static_cast<double>(robot.getJointPos(0)) - start;
  // At the start and the stop it slides by v^2 / (2 mu g), once back and once ahead.
  EXPECT_NEAR(slip, 0, 3e-3);
  EXPECT_NEAR(momentum_of(sheet).x(), 0, 1e-4);
}

// A tray on a vertical slider without a motor floats on a force that bears the tray alone: with cloth on it, it falls by
// m g / (m + M).
TEST(MultiBody, AJointFeelsTheWeightOfCloth) {
  RobotWorld world;
  const btVector3 half(btScalar(0.5), btScalar(0.05), btScalar(0.5));
  constexpr double kTray = 2;
  constexpr double kCloth = 0.5;
  btMultiBody& robot = world.add_robot(1, 0, btVector3(0, 0, 0), btVector3(0, -1, 0));
  robot.setupPrismatic(0, btScalar(kTray), box_inertia(kTray, half), -1,
                       btQuaternion::getIdentity(), btVector3(0, 1, 0),
                       btVector3(0, btScalar(0.94), 0), btVector3(0, 0, 0), true);
  world.finish(robot);
  world.add_collider(robot, 0, half);
  btSoftBody& sheet =
      world.add_cloth(cloth(13, 0.4, 0.0, kCloth), {law("tension", "stiffness", 500)});
  for (int step = 0; step < 60; ++step) {
    robot.addJointTorque(0, btScalar(kTray * 9.81));
    world.step();
  }
  const double expected = -9.81 * kCloth / (kCloth + kTray);
  EXPECT_NEAR(static_cast<double>(robot.getJointVel(0)), expected, 0.02 * std::abs(expected));
  EXPECT_NEAR(momentum_of(sheet).y() / kCloth, expected, 0.02 * std::abs(expected));
}

// Bullet undoes in each step what cloth has done to a joint with a motor. Without a memory cloth would creep down by m g h^2 / M
// in each step: 6 mm/s here.
TEST(MultiBody, ClothDoesNotCreepOnALinkThatAMotorHolds) {
  RobotWorld world;
  const btVector3 half(btScalar(0.5), btScalar(0.05), btScalar(0.5));
  btMultiBody& robot = world.add_robot(1, 0, btVector3(0, 0, 0), btVector3(0, -1, 0));
  // Along a slope of 20 degrees, with friction enough to hold.
  const btQuaternion tilt(btVector3(0, 0, 1), btScalar(0.35));
  robot.setupPrismatic(0, 1, box_inertia(1, half), -1, tilt, btVector3(1, 0, 0),
                       btVector3(0, btScalar(0.94), 0), btVector3(0, 0, 0), true);
  world.finish(robot);
  world.add_collider(robot, 0, half);
  world.add_motor(robot, 0, 0, 1000);
  ClothMesh mesh = cloth(13, 0.4, 0.0, 0.5);
  const btTransform pose = robot.getLink(0).m_collider->getWorldTransform();
  for (Eigen::Index i = 0; i < mesh.rest_positions.cols(); ++i) {
    const Vector3<double> x = mesh.rest_positions.col(i);
    mesh.rest_positions.col(i) = from_bullet(pose * vector(x.x(), 0.061, x.z()));
  }
  btSoftBody& sheet = world.add_cloth(mesh, {law("tension", "stiffness", 500)}, 1.0);
  world.step(120);
  const Vector3<double> start = mean_position(sheet);
  world.step(300);
  EXPECT_LT((mean_position(sheet) - start).norm(), 1e-4);
  EXPECT_NEAR(static_cast<double>(robot.getJointPos(0)), 0, 1e-3);
}

TEST(MultiBody, AnAnchorToALinkLeadsItsNodeAndPullsTheJoint) {
  RobotWorld world;
  const btVector3 half(btScalar(0.05), btScalar(0.05), btScalar(0.05));
  btMultiBody& robot = world.add_robot(1, 0, btVector3(0, 0, 0), btVector3(0, 0, 0));
  robot.setupPrismatic(0, 1, box_inertia(1, half), -1, btQuaternion::getIdentity(),
                       btVector3(0, 1, 0), btVector3(0, 1, 0), btVector3(0, 0, 0), true);
  world.finish(robot);
  btMultiBodyLinkCollider& hook = world.add_collider(robot, 0, half);
  btSoftBody& sheet = world.add_cloth(cloth(9, 0.4, 0.8, 0.4), {law("tension", "stiffness", 500)});
  world.step();
  sheet.appendDeformableAnchor(40, &hook);
  const btVector3 local = sheet.m_deformableAnchors[0].m_local;
  for (int step = 0; step < 60; ++step) {
    robot.addJointTorque(0, btScalar(1 * 9.81));
    world.step();
    const btVector3 wanted = hook.getWorldTransform() * local;
    // By what the motion of the present step is still to come.
    EXPECT_LT((sheet.m_nodes[40].m_x - wanted).length(), 0.01) << step;
  }
  // Nothing but the weight of the cloth moves both, and what the slider fell before its torque bore it.
  const double momentum = momentum_of(sheet).y() + static_cast<double>(robot.getJointVel(0));
  EXPECT_NEAR(momentum, -9.81 * (61 * 0.4 + 1) * RobotWorld::kStep, 2e-3);
  EXPECT_LT(robot.getJointVel(0), -0.5);
}

TEST(MultiBody, InertiaIsThatOfBullet) {
  RobotWorld world(0);
  const btVector3 half(btScalar(0.2), btScalar(0.05), btScalar(0.1));
  btMultiBody& robot = world.add_robot(3, 1.5, box_inertia(1.5, half), btVector3(0, 1, 0));
  robot.setupRevolute(0, 1, box_inertia(1, half), -1,
                      btQuaternion(btVector3(0, 1, 0), btScalar(0.4)), btVector3(0, 0, 1),
                      btVector3(btScalar(0.2), 0, 0), btVector3(btScalar(0.2), 0, 0), true);
  robot.setupPrismatic(1, btScalar(0.5), box_inertia(0.5, half), 0, btQuaternion::getIdentity(),
                       btVector3(0, 1, 0), btVector3(btScalar(0.2), btScalar(0.1), 0),
                       btVector3(btScalar(0.1), 0, 0), true);
  robot.setupSpherical(2, btScalar(0.7), box_inertia(0.7, half), 1,
                       btQuaternion(btVector3(1, 0, 0), btScalar(0.3)),
                       btVector3(btScalar(0.1), 0, 0), btVector3(btScalar(0.2), 0, 0), true);
  world.finish(robot);
  robot.setJointPos(0, btScalar(0.7));
  robot.setJointPos(1, btScalar(0.1));
  world.add_collider(robot, 2, half);
  // Bullet's articulated-body algorithm, in the pose of the step that it has just prepared.
  btAlignedObjectArray<btScalar> scratch;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
  robot.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scratch, vectors, matrices, false,
                                                             false, false);
  const int size = 6 + robot.getNumDofs();
  const MultiBodyInertia inertia(robot);
  const btVector3 center = robot.getLink(2).m_collider->getWorldTransform().getOrigin();
  for (int k = 0; k < 6; ++k) {
    const btVector3 unit(k % 3 == 0, k % 3 == 1, k % 3 == 2);
    VectorX<btScalar> row(size);
    robot.fillConstraintJacobianMultiDof(2, center, k < 3 ? btVector3(0, 0, 0) : unit,
                                         k < 3 ? unit : btVector3(0, 0, 0), row.data(), scratch,
                                         vectors, matrices);
    EXPECT_NEAR((inertia.jacobian_of(2).row(k).transpose() - row.cast<double>()).norm(), 0, 1e-5)
        << k;
    VectorX<btScalar> response(size);
    robot.calcAccelerationDeltasMultiDof(row.data(), response.data(), scratch, vectors);
    const VectorX<double> own = inertia.response_to(row.cast<double>());
    EXPECT_NEAR((own - response.cast<double>()).norm(), 0, 1e-3 * own.norm()) << k;
  }
}

// Cloth falls on a plate whose joint the program leads: it goes along and the joint feels nothing.
TEST(MultiBody, AKinematicBaseCarriesCloth) {
  RobotWorld world;
  const btVector3 half(2, btScalar(0.05), 1);
  btMultiBody& robot = world.add_robot(0, 0, btVector3(0, 0, 0), btVector3(0, btScalar(-0.06), 0));
  world.finish(robot);
  btMultiBodyLinkCollider& collider = world.add_collider(robot, -1, half);
  collider.setDynamicType(btCollisionObject::CF_KINEMATIC_OBJECT);
  btSoftBody& sheet =
      world.add_cloth(cloth(13, 0.4, 0.011, 0.1), {law("tension", "stiffness", 500)}, 0.6);
  world.step(30);
  const double start = mean_position(sheet).x();
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> origins;
  const double speed = 0.3;  // [m/s]
  for (int step = 1; step <= 60; ++step) {
    robot.setBasePos(vector(speed * RobotWorld::kStep * step, -0.06, 0));
    robot.updateCollisionObjectWorldTransforms(rotations, origins);
    world.step();
  }
  EXPECT_NEAR(mean_position(sheet).x() - start, speed, 0.01);
  EXPECT_NEAR(momentum_of(sheet).x() / 0.1, speed, 0.01);
}

}  // namespace
}  // namespace weft::bridge
