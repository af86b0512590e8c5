#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>

#include "tests/bridge/spring_body.hpp"

namespace weft::bridge {
namespace {

using testing::add_body;
using testing::displace;
using testing::kTimeStep;
using testing::law;
using testing::set_velocity;
using testing::spring_chain;

constexpr double kEpsilon = std::numeric_limits<btScalar>::epsilon();

DeformableWorldSettings implicit_settings() {
  DeformableWorldSettings settings;
  settings.scheme = DeformableScheme::kImplicit;
  return settings;
}

double x_of(const btSoftBody& body, int node) {
  return static_cast<double>(body.m_nodes[node].m_x.x());
}
double v_of(const btSoftBody& body, int node) {
  return static_cast<double>(body.m_nodes[node].m_v.x());
}

TEST(DeformableForces, FreeFallIsTheSymplecticEulerParabola) {
  DeformableWorld world({});
  btSoftBody& body =
      add_body(world, spring_chain(3, 0), {law("gravity", "acceleration", {0, -9.81, 0})});
  const int num_steps = 100;
  for (int step = 0; step < num_steps; ++step) world.step(kTimeStep);
  const double drop = 9.81 * kTimeStep * kTimeStep * num_steps * (num_steps + 1) / 2;
  // One rounding of position and velocity per step.
  EXPECT_NEAR(static_cast<double>(body.m_nodes[1].m_x.y()), -drop, 2 * num_steps * kEpsilon * drop);
}

// One node on a spring from a pinned one, along the spring, against the recurrence of the scheme.
class Oscillator : public ::testing::Test {
 protected:
  static constexpr double kStiffness = 400.0;  // [N/m] on 1 kg: w = 20 / s, h w = 0.16
  static constexpr double kOffset = 0.125;     // [m]
  static constexpr int kSteps = 200;
  bool line_search_ = false;  // of implicit steps, with the laws' energies

  template <class Step>
  void expect_recurrence(const DeformableWorldSettings& settings,
                         const std::vector<forces::LawSpecification>& laws, double solver_error,
                         Step step) {
    DeformableWorld world(settings);
    world.world().setLineSearch(line_search_);
    btSoftBody& body = add_body(world, spring_chain(2, 1), laws);
    displace(body, 1, {btScalar(kOffset), 0, 0});
    double x = kOffset;
    double v = 0;
    // Rounding of a position of 1 m acts through w^2 h on the velocity, every step; an oscillator
    // hands such errors on without growth.
    const double per_step = kEpsilon * (1 + kStiffness * kTimeStep) + solver_error;
    for (int n = 1; n <= kSteps; ++n) {
      world.step(kTimeStep);
      step(x, v);
      ASSERT_NEAR(x_of(body, 1), 1 + x, n * per_step) << "step " << n;
      ASSERT_EQ(x_of(body, 0), 0.0);
    }
  }
};

TEST_F(Oscillator, ExplicitStepIsSymplecticEuler) {
  expect_recurrence({}, {law("tension", "stiffness", {kStiffness})}, 0.0, [](double& x, double& v) {
    v -= kTimeStep * kStiffness * x;
    x += kTimeStep * v;
  });
}

TEST_F(Oscillator, ExplicitStepTakesTheDamperImplicitly) {
  const double damping = 30.0;           // [N s/m]
  const double solver_tolerance = 1e-8;  // [m/s] of Bullet's conjugate residuals, absolute
  expect_recurrence(
      {}, {law("tension", "stiffness", {kStiffness}), law("spring_damping", "damping", {damping})},
      solver_tolerance, [&](double& x, double& v) {
        v = (v - kTimeStep * kStiffness * x) / (1 + kTimeStep * damping);
        x += kTimeStep * v;
      });
}

TEST_F(Oscillator, ImplicitStepIsBackwardEulerWithAndWithoutLineSearch) {
  for (const bool line_search : {false, true}) {
    line_search_ = line_search;
    const double damping = 3.0;  // [N s/m]
    expect_recurrence(
        implicit_settings(),
        {law("tension", "stiffness", {kStiffness}), law("spring_damping", "damping", {damping})},
        0.0, [&](double& x, double& v) {
          v = (v - kTimeStep * kStiffness * x) /
              (1 + kTimeStep * damping + kTimeStep * kTimeStep * kStiffness);
          x += kTimeStep * v;
        });
  }
}

TEST_F(Oscillator, ImplicitStepIsStableFarBeyondTheExplicitLimit) {
  const double stiffness = 4e6;  // [N/m] h w = 16
  DeformableWorld world(implicit_settings());
  btSoftBody& body =
      add_body(world, spring_chain(2, 1), {law("tension", "stiffness", {stiffness})});
  displace(body, 1, {btScalar(kOffset), 0, 0});
  world.step(kTimeStep);
  const double factor = 1 / (1 + kTimeStep * kTimeStep * stiffness);
  EXPECT_NEAR(x_of(body, 1), 1 + kOffset * factor, 4 * kEpsilon * (1 + kOffset / factor));
}

TEST(DeformableForces, VelocityDampingIsBackwardEulerInBothModes) {
  const double rate = 2.0;  // [1/s]
  for (const auto& settings : {DeformableWorldSettings{}, implicit_settings()}) {
    DeformableWorld world(settings);
    btSoftBody& body =
        add_body(world, spring_chain(3, 0), {law("velocity_damping", "rate", {rate})});
    for (int i = 0; i < 3; ++i) set_velocity(body, i, {1, 0, 0});
    const int num_steps = 64;
    for (int step = 0; step < num_steps; ++step) world.step(kTimeStep);
    const double solver_tolerance = 1e-8;  // [m/s] absolute, per step
    EXPECT_NEAR(v_of(body, 1), std::pow(1 + rate * kTimeStep, -num_steps),
                num_steps * (4 * kEpsilon + solver_tolerance));
  }
}

// Momentum and angular momentum about the origin of a body of 1 kg nodes.
std::pair<Vector3<double>, Vector3<double>> momenta(const btSoftBody& body) {
  Vector3<double> linear = Vector3<double>::Zero();
  Vector3<double> angular = Vector3<double>::Zero();
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btVector3& x = body.m_nodes[i].m_x;
    const btVector3& v = body.m_nodes[i].m_v;
    const Vector3<double> velocity = Vector3<btScalar>(v.x(), v.y(), v.z()).cast<double>();
    linear += velocity;
    angular += Vector3<btScalar>(x.x(), x.y(), x.z()).cast<double>().cross(velocity);
  }
  return {linear, angular};
}

TEST(DeformableForces, InternalLawsKeepMomentumAndAngularMomentum) {
  DeformableWorld world({});
  btSoftBody& body =
      add_body(world, spring_chain(6, 0),
               {law("tension", "stiffness", {200.0}), law("spring_damping", "damping", {3.0})});
  for (int i = 0; i < 6; ++i) {
    set_velocity(body, i, {btScalar(0.1 * i), btScalar(i % 3 - 1), btScalar((i * i) % 5 - 2)});
  }
  const auto [linear, angular] = momenta(body);
  const int num_steps = 200;
  for (int step = 0; step < num_steps; ++step) world.step(kTimeStep);
  const auto [linear_after, angular_after] = momenta(body);
  // Rounding of 6 velocities of 3 m/s per step, at arms up to 10 m, and what the solver leaves.
  const double per_step = 6 * (3 * kEpsilon + 1e-8);
  EXPECT_LT((linear_after - linear).norm(), num_steps * per_step);
  EXPECT_LT((angular_after - angular).norm(), num_steps * per_step * 10);
}

// world.addForce() would merge the second body into the first one's force, constants and all.
TEST(DeformableForces, BodiesWithTheSameLawKeepTheirOwnParameters) {
  DeformableWorld world({});
  btSoftBody& soft = add_body(world, spring_chain(2, 1), {law("tension", "stiffness", {100.0})});
  btSoftBody& hard = add_body(world, spring_chain(2, 1), {law("tension", "stiffness", {300.0})});
  const double offset = 0.25;  // [m]
  for (btSoftBody* body : {&soft, &hard}) displace(*body, 1, {btScalar(offset), 0, 0});
  world.step(kTimeStep);
  EXPECT_NEAR(v_of(soft, 1), -kTimeStep * 100 * offset, 100 * kTimeStep * kEpsilon);
  EXPECT_NEAR(v_of(hard, 1), -kTimeStep * 300 * offset, 300 * kTimeStep * kEpsilon);
}

TEST(DeformableForces, BodiesMayComeAndGo) {
  for (const auto& settings : {DeformableWorldSettings{}, implicit_settings()}) {
    DeformableWorld world(settings);
    const ClothMesh mesh = spring_chain(2, 0);
    const std::vector<forces::LawSpecification> gravity = {
        law("gravity", "acceleration", {-8, 0, 0})};
    auto first = make_cloth_body(world.info(), mesh, {});
    prepare_for_deformable_world(*first);
    world.forces().attach(*first, mesh, gravity);  // before it is in the world
    world.world().addSoftBody(first.get());
    btSoftBody& second = add_body(world, spring_chain(3, 1), gravity);
    world.step(kTimeStep);
    world.world().removeSoftBody(first.get());
    EXPECT_FALSE(world.forces().has_laws(*first));
    first.reset();
    world.step(kTimeStep);
    btSoftBody& third = add_body(world, mesh, gravity);
    world.step(kTimeStep);
    const double tolerance = 16 * kEpsilon;  // a few roundings of velocities below 1 m/s
    EXPECT_NEAR(v_of(second, 2), -3 * 8 * kTimeStep, tolerance);
    EXPECT_NEAR(v_of(third, 0), -8 * kTimeStep, tolerance);
    EXPECT_EQ(v_of(second, 0), 0.0);
    world.forces().detach(second);
    world.step(kTimeStep);
    EXPECT_NEAR(v_of(second, 2), -3 * 8 * kTimeStep, tolerance);
    EXPECT_NEAR(v_of(third, 0), -2 * 8 * kTimeStep, tolerance);
  }
}

TEST(DeformableForces, PinnedNodesKeepEveryBit) {
  ClothGrid grid;
  grid.nodes = {7, 6};
  grid.center = {0.1, 0.2, 0.3};
  ClothMesh mesh = make_cloth_grid(grid);
  mesh.pinned = {0, 6, 20};
  for (const auto& settings : {DeformableWorldSettings{}, implicit_settings()}) {
    DeformableWorld world(settings);
    btSoftBody& body = add_body(
        world, mesh,
        {law("tension", "stiffness", {60.0}), law("spring_damping", "damping", {0.02}),
         law("velocity_damping", "rate", {0.5}), law("gravity", "acceleration", {0, -9.81, 0})});
    std::vector<btVector3> before;
    for (const int node : mesh.pinned) before.push_back(body.m_nodes[node].m_x);
    for (int step = 0; step < 100; ++step) world.step(kTimeStep);
    for (std::size_t p = 0; p < mesh.pinned.size(); ++p) {
      const btSoftBody::Node& node = body.m_nodes[mesh.pinned[p]];
      EXPECT_TRUE(node.m_x == before[p]) << mesh.pinned[p];
      EXPECT_TRUE(node.m_v == btVector3(0, 0, 0)) << mesh.pinned[p];
    }
    EXPECT_LT(body.m_nodes[40].m_x.y(), before[0].y());  // the rest hangs
  }
}

TEST(DeformableForces, ForcesOnNodesActForOneStep) {
  for (const auto& settings : {DeformableWorldSettings{}, implicit_settings()}) {
    DeformableWorld world(settings);
    btSoftBody& body = add_body(world, spring_chain(2, 0), {});
    world.step(kTimeStep);
    body.addForce(btVector3(4, 0, 0), 1);
    world.step(kTimeStep);
    world.step(kTimeStep);
    EXPECT_NEAR(v_of(body, 1), 4 * kTimeStep, 4 * kEpsilon);
    EXPECT_EQ(v_of(body, 0), 0.0);
  }
}

TEST(DeformableForces, TheSameRunGivesTheSameBits) {
  ClothGrid grid;
  grid.nodes = {9, 9};
  const ClothMesh mesh = make_cloth_grid(grid);
  const auto run = [&](const DeformableWorldSettings& settings) {
    DeformableWorld world(settings);
    auto shape = std::make_unique<btSphereShape>(btScalar(0.4));
    const btTransform below(btQuaternion::getIdentity(), btVector3(0, btScalar(-0.45), 0));
    auto ball = std::make_unique<btRigidBody>(btScalar(0), nullptr, shape.get());
    ball->setWorldTransform(below);
    world.add(std::move(ball), std::move(shape));
    btSoftBody& body = add_body(
        world, mesh,
        {law("tension", "stiffness", {60.0}), law("gravity", "acceleration", {0, -9.81, 0})});
    for (int step = 0; step < 60; ++step) world.step(kTimeStep);
    std::vector<btScalar> bits;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) bits.push_back(body.m_nodes[i].m_x[axis]);
    }
    return bits;
  };
  EXPECT_EQ(run({}), run({}));
  EXPECT_EQ(run(implicit_settings()), run(implicit_settings()));
}

}  // namespace
}  // namespace weft::bridge
