// Fast cloth that lies between two bodies which press on each other: what it bears, with what friction, and that it gains nothing.
#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <vector>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <gtest/gtest.h>

#include <weft/bridge/snapshot.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

constexpr double kGravityOfEarth = 9.81;  // [m/s^2]

double speed_of(const btRigidBody& body) {
  return static_cast<double>(body.getLinearVelocity().length());
}

double height_of(const btRigidBody& body) {
  return static_cast<double>(body.getCenterOfMassPosition().y());
}

double energy_of(const btRigidBody& body) {
  const auto mass = static_cast<double>(body.getMass());
  return 0.5 * mass * speed_of(body) * speed_of(body) + mass * kGravityOfEarth * height_of(body);
}

/// A cloth of 0.2 kg on a table, whose top is as far below it as the margins of both are wide.
class Table {
 public:
  explicit Table(double stiffness, double friction_of_table = 0.3)
      : scene_(cloth(21, 0.8, 0, 0.2), {kGravity, law("tension", "stiffness", stiffness)}, 1.0) {
    table_ = &scene_.add(box(1.6, 0.04, 0.6), 0, at(0, kTop - 0.04, 0));
    table_->setFriction(btScalar(friction_of_table));
  }
  btRigidBody& add_box(double mass, double friction = 0.3) {
    btRigidBody& body = scene_.add(box(0.1, 0.1, 0.1), mass, at(0.03, 0.1 + kMargin, 0.02));
    body.setFriction(btScalar(friction));
    return body;
  }
  Scene& scene() { return scene_; }
  /// [N] That the table bears in a step.
  double load(double time_step) {
    double sum = 0;
    for (const NodeContact& contact : scene_.solver().rigid_contacts(scene_.body())) {
      if (contact.object == table_) sum += static_cast<double>(contact.impulse.y());
    }
    return sum / time_step;
  }
  /// Pulls one edge along the table.
  void pull(double velocity, double time_step, double time) {
    std::vector<int> edge;
    for (int i = 0; i < scene_.body().m_nodes.size(); ++i) {
      if (scene_.body().m_nodes[i].m_x.x() > 0.39) edge.push_back(i);
    }
    for (const int i : edge) scene_.body().setMass(i, 0);
    const int num_steps = static_cast<int>(std::lround(time / time_step));
    for (int step = 0; step < num_steps; ++step) {
      for (const int i : edge) {
        scene_.body().m_nodes[i].m_x += btVector3(btScalar(velocity * time_step), 0, 0);
      }
      scene_.step(1, time_step);
    }
  }
  static constexpr double kTop = -kMargin;

 private:
  Scene scene_;
  btRigidBody* table_;
};

struct Throw {
  double time_step;
  double velocity;
  double mass;
  double stiffness;
};

class ThrownBall : public testing::TestWithParam<Throw> {};

// One plane for a node at a time let a ball sink through to the table, and threw it back: 2 kg that came at 1 m/s left at 15.
TEST_P(ThrownBall, GainsNothing) {
  const Throw& thrown = GetParam();
  Table table(thrown.stiffness);
  btRigidBody& ball = table.scene().add(std::make_shared<btSphereShape>(btScalar(0.1)), thrown.mass,
                                        at(0.03, 0.22, 0.02));
  ball.setLinearVelocity(vector(0, -thrown.velocity, 0));
  const auto energy = [&] { return table.scene().mechanical_energy(0) + energy_of(ball); };
  const double first = energy();
  double most = -first;
  double fastest = 0;
  double lowest = height_of(ball);
  const int num_steps =
      static_cast<int>(std::lround((0.1 / thrown.velocity + 0.15) / thrown.time_step));
  for (int step = 0; step < num_steps; ++step) {
    table.scene().step(1, thrown.time_step);
    most = std::max(most, energy());
    fastest = std::max(fastest, static_cast<double>(ball.getLinearVelocity().y()));
    lowest = std::min(lowest, height_of(ball));
  }
  EXPECT_LE(most, first);
  EXPECT_LT(fastest, 0.5 * thrown.velocity) << "it does not bounce";
  // Between nodes it may come 2 mm deeper, and the impact takes the rest.
  const double held = Table::kTop + 2 * kMargin + 0.1;
  // It may come and go within one step.
  EXPECT_LT(lowest, held + 0.005 + fastest * thrown.time_step) << "it has come down";
  EXPECT_GT(lowest, held - 0.002 * std::max(10.0, thrown.velocity)) << "it is not pressed through";
}

std::vector<Throw> throws() {
  if (!WEFT_ALL_THROWS) {
    return {{1.0 / 60, 1, 2, 20000},
            {1.0 / 60, 4, 0.2, 2000},
            {1.0 / 60, 10, 2, 2000},
            {1.0 / 240, 1, 0.2, 2000},
            {1.0 / 240, 1, 2, 20000},
            {1.0 / 240, 10, 0.2, 20000},
            {1.0 / 240, 4, 0.02, 20000},
            // It touches the table, and leaves it within the substeps of one step.
            {1.0 / 90, 15, 0.02, 1000},
            {1.0 / 70, 15, 0.005, 200}};
  }
  std::vector<Throw> all;
  for (const double time_step : {1.0 / 60, 1.0 / 90, 1.0 / 240}) {
    for (const double velocity : {1.0, 4.0, 7.0, 10.0, 15.0}) {
      for (const double mass : {0.005, 0.02, 0.2, 0.7, 2.0}) {
        for (const double stiffness : {50.0, 200.0, 2000.0, 7000.0, 20000.0}) {
          all.push_back({time_step, velocity, mass, stiffness});
        }
      }
    }
  }
  return all;
}

void PrintTo(const Throw& one, std::ostream* out) {
  *out << one.mass << " kg at " << one.velocity << " m/s, " << one.stiffness << " N/m, steps of "
       << one.time_step << " s";
}

INSTANTIATE_TEST_SUITE_P(Throws, ThrownBall, testing::ValuesIn(throws()));

// Nodes that the ball has pressed in come out by themselves after it has left. Which ones they are is part of the state.
TEST(ClothBetween, GoesOnFromASnapshot) {
  for (const int num_steps : {6, 7, 8, 9, 11}) {  // the ball leaves in the 9th
    std::vector<double> heights[2];
    Snapshot snapshot;
    for (std::vector<double>& of_run : heights) {
      Table table(20000);
      btRigidBody& ball = table.scene().add(std::make_shared<btSphereShape>(btScalar(0.1)), 0.02,
                                            at(0.03, 0.22, 0.02));
      ball.setLinearVelocity(vector(0, -4, 0));
      if (&of_run == heights) {
        table.scene().step(num_steps, 1.0 / 240);
        snapshot.save(table.scene().world().world(), table.scene().solver());
      } else {
        snapshot.restore(table.scene().world().world(), table.scene().solver());
      }
      for (int step = 0; step < 12; ++step) {
        table.scene().step(1, 1.0 / 240);
        of_run.push_back(height_of(ball));
        for (int i = 0; i < table.scene().body().m_nodes.size(); ++i)
          of_run.push_back(static_cast<double>(table.scene().body().m_nodes[i].m_x.y()));
      }
    }
    EXPECT_EQ(heights[0], heights[1]) << "after " << num_steps << " steps";
  }
}

// A light box that tumbles touches the table through the cloth with edges that come and go, and steps that are divided into many
// substeps follow steps that are not. What was left inside of something at the end of a step was thrown out in the first substep.
struct Tumble {
  double time_step;
  double turned;  ///< [rad] at the start
};

class TumblingBox : public testing::TestWithParam<Tumble> {};

TEST_P(TumblingBox, GainsNothing) {
  constexpr double kMass = 0.01;
  constexpr double kSpeed = 2.0;
  const Tumble& tumble = GetParam();
  Table table(5000);
  btRigidBody& body = table.scene().add(box(0.1, 0.05, 0.08), kMass, at(0.03, 0.3, 0.02));
  btTransform start = body.getCenterOfMassTransform();
  start.setRotation(btQuaternion(btVector3(1, 2, -2) / 3, btScalar(tumble.turned)));
  body.setCenterOfMassTransform(start);
  body.setFriction(btScalar(0.5));
  body.setLinearVelocity(vector(0.4, -kSpeed, -0.2));
  body.setAngularVelocity(vector(6, -5, 5));
  const auto energy = [&] {
    const btVector3 turning =
        body.getCenterOfMassTransform().getBasis().transpose() * body.getAngularVelocity();
    return table.scene().mechanical_energy(0) + energy_of(body) +
           0.5 * static_cast<double>((body.getLocalInertia() * turning).dot(turning));
  };
  // Margins press each other apart: some 0.2 mJ. It was 14 to 130 mJ.
  const double least = 0.02 * 0.5 * kMass * kSpeed * kSpeed;
  double last = energy();
  for (int step = 0; step * tumble.time_step < 0.6; ++step) {
    table.scene().step(1, tumble.time_step);
    const double now = energy();
    EXPECT_LT(now, last + least) << "in step " << step;
    EXPECT_GT(height_of(body), Table::kTop + 2 * kMargin)
        << "it is not pressed through, in step " << step;
    last = now;
  }
}

void PrintTo(const Tumble& one, std::ostream* out) {
  *out << "turned by " << one.turned << " rad, steps of " << one.time_step << " s";
}

INSTANTIATE_TEST_SUITE_P(Tumbles, TumblingBox,
                         testing::Values(Tumble{1.0 / 30, 0.3}, Tumble{1.0 / 30, 1.3},
                                         Tumble{1.0 / 60, 0.3}, Tumble{1.0 / 60, 1.8}));

// A jerk of 1 m/s gave the box ten times what friction on it can, 0.45 m/s, in a single step; now 1.2 times.
TEST(ClothOnATable, IsPulledInSubsteps) {
  Table table(20000);
  const btRigidBody& body = table.add_box(2.0);
  table.scene().step(30);
  table.pull(1.0, kTimeStep, kTimeStep);
  EXPECT_GT(body.getLinearVelocity().x(), 0.5 * 0.3 * kGravityOfEarth * kTimeStep);
  EXPECT_LT(body.getLinearVelocity().x(), 2 * 0.3 * kGravityOfEarth * kTimeStep);
}

// It flew off at 10 m/s and more. How deep it presses the margins together is a matter of its weight, not of the step.
TEST(ClothOnATable, BearsABox) {
  std::vector<double> depths;
  for (const double time_step : {1.0 / 60, 1.0 / 240}) {
    Table table(2000);
    const btRigidBody& body = table.add_box(1);
    table.scene().step(static_cast<int>(std::lround(1.5 / time_step)), time_step);
    EXPECT_LT(speed_of(body), 1e-3) << time_step;
    EXPECT_NEAR(table.load(time_step), 1.2 * kGravityOfEarth, 0.01 * 1.2 * kGravityOfEarth);
    depths.push_back(Table::kTop + 2 * kMargin - (height_of(body) - 0.1));
    EXPECT_GT(depths.back(), 0) << time_step;
    EXPECT_LT(depths.back(), 5e-4) << time_step;
  }
  EXPECT_NEAR(depths[0], depths[1], 1e-4);
}

// Friction accelerates the box at mu g until it goes along.
TEST(ClothOnATable, CarriesABoxThatIsPulledSlowly) {
  constexpr double kVelocity = 0.5;
  for (const double friction : {0.05, 0.3}) {
    Table table(2000);
    const btRigidBody& body = table.add_box(1, friction);
    table.scene().step(240, 1.0 / 240);
    const auto before = static_cast<double>(body.getCenterOfMassPosition().x());
    table.pull(kVelocity, 1.0 / 240, 0.6);
    const double acceleration = friction * kGravityOfEarth;
    const double time = std::min(0.6, kVelocity / acceleration);
    const double right = acceleration * time * time / 2 + kVelocity * (0.6 - time);
    const double moved = static_cast<double>(body.getCenterOfMassPosition().x()) - before;
    EXPECT_NEAR(moved, right, 0.05 * right) << friction;
  }
}

TEST(ClothOnATable, SlipsOutFromUnderABoxThatIsPulledFast) {
  Table table(2000);
  const btRigidBody& body = table.add_box(1);
  table.scene().step(240, 1.0 / 240);
  const auto before = static_cast<double>(body.getCenterOfMassPosition().x());
  table.pull(3, 1.0 / 240, 0.8);
  EXPECT_NEAR(height_of(body), Table::kTop + 0.1, 1e-3) << "it stands on the table";
  EXPECT_LT(speed_of(body), 0.3);
  EXPECT_LT(static_cast<double>(body.getCenterOfMassPosition().x()) - before, 0.3);
}

// Both are dynamic: what one gets the other loses.
TEST(ClothBetweenBoxes, BearsTheUpperOne) {
  for (const double upper : {0.2, 1.0, 5.0}) {
    Scene scene(cloth(21, 0.8, 0, 0.2), {kGravity, law("tension", "stiffness", 2000)}, 1.0);
    scene.add(box(0.6, 0.04, 0.6), 0, at(0, -0.24 - kMargin - 0.001, 0));
    const btRigidBody& below = scene.add(box(0.2, 0.1, 0.2), 1, at(0, -0.1 - kMargin - 0.001, 0));
    const btRigidBody& above = scene.add(box(0.1, 0.1, 0.1), upper, at(0.03, 0.1 + kMargin, 0.02));
    scene.step(90);
    EXPECT_LT(speed_of(below), 0.02) << upper;
    EXPECT_LT(speed_of(above), 0.02) << upper;
    EXPECT_NEAR(height_of(above) - height_of(below), 0.2 + 2 * kMargin, 3e-3) << upper;
  }
}

// A body that presses on nodes between two plates that the program holds has no say there.
TEST(ClothBetweenPlates, IsHeldByThemBesideABody) {
  Scene scene(cloth(21, 0.8, 0, 0.2), {kGravity, law("tension", "stiffness", 2000)}, 1.0);
  for (const double height : {-0.05, 0.05}) {
    btRigidBody& plate = scene.add(box(0.3, 0.045, 0.3), 0, at(0, height, 0));
    plate.setCollisionFlags(plate.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    plate.setActivationState(DISABLE_DEACTIVATION);
  }
  const btRigidBody& body = scene.add(box(0.1, 0.045, 0.1), 1, at(0.05, 0.0495, 0));
  scene.step(30);
  EXPECT_GT(scene.solver().num_contacts(scene.body()), 400);
  EXPECT_LT(scene.velocities().colwise().norm().maxCoeff(), 5);
  EXPECT_TRUE(std::isfinite(height_of(body)));
}

}  // namespace
}  // namespace weft::bridge
