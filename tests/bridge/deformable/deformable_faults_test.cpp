// What goes wrong in Bullet's deformable world, and what Weft does about it: repaired or refused.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/bridge/deformable/bullet_deformable.hpp>
#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include "tests/bridge/spring_body.hpp"

namespace weft::bridge {
namespace {

using testing::add_body;
using testing::displace;
using ::testing::HasSubstr;
using testing::kTimeStep;
using testing::law;
using testing::set_velocity;
using testing::spring_chain;

constexpr double kDeformableFaultsEpsilon = std::numeric_limits<btScalar>::epsilon();

DeformableWorldSettings implicit_fault_settings() {
  DeformableWorldSettings settings;
  settings.scheme = DeformableScheme::kImplicit;
  return settings;
}

/// A deformable world around any solver, as an application makes it.
struct PlainWorld {
  explicit PlainWorld(btDeformableBodySolver& solver)
      : world((constraints.setDeformableSolver(&solver), &dispatcher), &broadphase, &constraints,
              &configuration, &solver) {}
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btDeformableMultiBodyConstraintSolver constraints;
  btDeformableMultiBodyDynamicsWorld world;
};

// Velocities [m/s] along x that an implicit step predicts for its contacts: Bullet's tick callback
// runs between the prediction and the solve.
std::vector<double> predicted_velocities(btDeformableMultiBodyDynamicsWorld& world,
                                         const btSoftBody& body) {
  struct Seen {
    const btSoftBody* body;
    std::vector<double> velocities;
  } seen{&body, {}};
  world.setInternalTickCallback(
      [](btDynamicsWorld* ticking, btScalar) {
        auto& result = *static_cast<Seen*>(ticking->getWorldUserInfo());
        for (int i = 0; i < result.body->m_nodes.size(); ++i) {
          result.velocities.push_back(static_cast<double>(result.body->m_nodes[i].m_v.x()));
        }
      },
      &seen);
  world.stepSimulation(static_cast<btScalar>(kTimeStep), 0);
  return seen.velocities;
}

// Chain of 1 kg nodes; node 3 is pulled out by 1/4 m, so that only nodes 2 and 3 feel a force.
constexpr double kStiffness = 64.0;                          // [N/m]
constexpr double kPull = 0.25;                               // [m]
constexpr double kImpulse = kTimeStep * kStiffness * kPull;  // [N s]

// Upstream fault a, in btDeformableBackwardEulerObjective::applyForce; b would add an uninitialised
// gravity to every number here.
TEST(DeformableFaults, ImplicitPredictionReachesTheNodeItBelongsTo) {
  DeformableWorld world(implicit_fault_settings());
  btSoftBody& body =
      add_body(world, spring_chain(4, 2), {law("tension", "stiffness", {kStiffness})});
  displace(body, 3, {btScalar(kPull), 0, 0});
  const std::vector<double> seen = predicted_velocities(world.world(), body);
  const double tolerance =
      kTimeStep * kStiffness * 4 * kDeformableFaultsEpsilon;  // rounding of positions of 4 m
  EXPECT_EQ(seen.at(0), 0.0);
  EXPECT_EQ(seen.at(1), 0.0);
  EXPECT_NEAR(seen.at(2), kImpulse, tolerance);
  EXPECT_NEAR(seen.at(3), -kImpulse, tolerance);
}

TEST(DeformableFaults, ImplicitGravityForceOfBulletMovesItsFreeNodesOnly) {
  DeformableWorld world(implicit_fault_settings());
  btSoftBody& falling = add_body(world, spring_chain(2, 1), {});
  btSoftBody& floating = add_body(world, spring_chain(2, 0), {});
  btDeformableGravityForce gravity(btVector3(-8, 0, 0));
  world.world().addForce(&falling, &gravity);
  const std::vector<double> seen = predicted_velocities(world.world(), falling);
  EXPECT_EQ(seen.at(0), 0.0);
  EXPECT_NEAR(seen.at(1), -8 * kTimeStep, 8 * kTimeStep * kDeformableFaultsEpsilon);
  EXPECT_EQ(floating.m_nodes[0].m_v.x(), btScalar(0));
  world.world().removeForce(&falling, &gravity);
}

TEST(DeformableFaults, ImplicitStepOfBulletsOwnSolverIsRefused) {
  btDeformableBodySolver solver;
  PlainWorld plain(solver);
  DeformableForces forces;
  forces.add_to(solver);
  plain.world.stepSimulation(static_cast<btScalar>(kTimeStep), 0);  // explicit: accepted
  plain.world.setImplicit(true);
  try {
    plain.world.stepSimulation(static_cast<btScalar>(kTimeStep), 0);
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected weft::bridge::DeformableSolver"));
  }
  forces.remove_from(solver);
  EXPECT_EQ(solver.getLagrangianForceArray()->size(), 0);
}

TEST(DeformableFaults, BulletsOwnSolverCarriesTheLawsExplicitly) {
  btDeformableBodySolver solver;
  PlainWorld plain(solver);
  DeformableForces forces;
  forces.add_to(solver);
  EXPECT_THROW(forces.add_to(solver), Error);
  const ClothMesh mesh = spring_chain(2, 1);
  const auto body = make_cloth_body(plain.world.getWorldInfo(), mesh, {});
  prepare_for_deformable_world(*body);
  plain.world.addSoftBody(body.get());
  forces.attach(*body, mesh, {law("gravity", "acceleration", {-8, 0, 0})});
  plain.world.stepSimulation(static_cast<btScalar>(kTimeStep), 0);
  EXPECT_NEAR(static_cast<double>(body->m_nodes[1].m_v.x()), -8 * kTimeStep,
              8 * kTimeStep * kDeformableFaultsEpsilon);
  plain.world.removeSoftBody(body.get());
  forces.remove_from(solver);
}

// Upstream fault c: "implicit not implemented", and a wrong result, without the projection.
TEST(DeformableFaults, ImplicitStepDoesNotDependOnAForgottenProjection) {
  const auto run = [](bool projection) {
    DeformableWorld world(implicit_fault_settings());
    world.world().setUseProjection(projection);
    btSoftBody& body =
        add_body(world, spring_chain(4, 2), {law("tension", "stiffness", {kStiffness})});
    displace(body, 3, {btScalar(kPull), btScalar(kPull), 0});
    for (int step = 0; step < 20; ++step) world.step(kTimeStep);
    return std::vector<btScalar>{body.m_nodes[2].m_x.x(), body.m_nodes[3].m_x.x(),
                                 body.m_nodes[3].m_x.y()};
  };
  ::testing::internal::CaptureStdout();
  const std::vector<btScalar> forgotten = run(false);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(forgotten, run(true));
}

void expect_refused(btSoftBody& body, const std::string& what) {
  DeformableForces forces;
  try {
    forces.attach(body, {}, VectorX<btScalar>::Ones(body.m_nodes.size()));
    ADD_FAILURE() << what << " is not refused";
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr(what));
    EXPECT_FALSE(forces.has_laws(body));
  }
}

// Upstream e: this world reads none of these, and says nothing.
TEST(DeformableFaults, WhatTheWorldIgnoresIsRefused) {
  btSoftBodyWorldInfo info;
  const auto make = [&] { return make_cloth_body(info, spring_chain(2, 0), {}); };
  auto body = make();
  body->m_windVelocity.setX(1);
  expect_refused(*body, "wind");
  for (const auto& [factor, what] :
       std::vector<std::pair<btScalar btSoftBody::Config::*, std::string>>{
           {&btSoftBody::Config::kDG, "kDG"},
           {&btSoftBody::Config::kLF, "kLF"},
           {&btSoftBody::Config::kPR, "kPR"},
           {&btSoftBody::Config::kVC, "kVC"},
           {&btSoftBody::Config::kMT, "kMT"},
           {&btSoftBody::Config::kDP, "kDP"}}) {
    body = make();
    body->m_cfg.*factor = btScalar(0.5);
    expect_refused(*body, what);
  }
  body = make();
  btSphereShape shape(1);
  btRigidBody rigid(1, nullptr, &shape);
  body->appendAnchor(0, &rigid);
  expect_refused(*body, "appendDeformableAnchor");
  body = make();
  body->appendLink(0, 1);
  EXPECT_THROW(prepare_for_deformable_world(*body), InvalidArgument);
}

TEST(DeformableFaults, WrongUseIsRefused) {
  DeformableWorld world({});
  const ClothMesh mesh = spring_chain(3, 0);
  btSoftBody& body = add_body(world, mesh, {});
  const VectorX<btScalar> masses = mesh.masses.cast<btScalar>();
  EXPECT_THROW(world.forces().attach(body, {}, masses), InvalidArgument);
  world.forces().detach(body);
  EXPECT_THROW(world.forces().attach(body, {}, VectorX<btScalar>::Ones(2)), InvalidArgument);
  EXPECT_THROW(
      world.forces().attach(
          body, make_laws(spring_chain(5, 0), {law("tension", "stiffness", {1.0})}), masses),
      InvalidArgument);
  for (const forces::LawInfo* info : forces::all_laws()) {
    if (info->traits.level != forces::LawTraits::Level::kInertia) continue;
    forces::LawSpecification slow{std::string(info->id), {}, {}};
    for (const auto& parameter : info->parameters) {
      slow.parameters[std::string(parameter.name)].assign(1, 0.5);
    }
    EXPECT_THROW(world.forces().attach(body, mesh, {slow}), InvalidArgument);
  }
  EXPECT_FALSE(world.forces().has_laws(body));
  EXPECT_THROW(DeformableWorld({.newton_iterations = 0}), InvalidArgument);
  EXPECT_THROW(DeformableWorld({.contact_iterations = 0}), InvalidArgument);
}

// Upstream fault f: what is not a number becomes zero, what is too fast is clamped.
TEST(DeformableFaults, ExplosionIsReportedAndFrozen) {
  ClothGrid grid;
  grid.nodes = {8, 8};
  grid.total_mass = 0.2;
  const ClothMesh mesh = make_cloth_grid(grid);
  DeformableWorld world({});
  // A thousand times beyond the stable step: every mode grows at once.
  btSoftBody& body = add_body(world, mesh, {law("tension", "stiffness", {1e6})});
  btSoftBody& other = add_body(world, mesh, {law("gravity", "acceleration", {0, -1, 0})});
  displace(body, 9, {btScalar(0.01), 0, 0});
  const int num_steps = 200;
  for (int step = 0; step < num_steps; ++step) world.step(kTimeStep);
  const auto blow_up = world.forces().blow_up(body);
  ASSERT_TRUE(blow_up.has_value());
  EXPECT_THAT(blow_up->reason, HasSubstr(" is over "));
  const btVector3 frozen = body.m_nodes[9].m_x;
  world.step(kTimeStep);
  EXPECT_TRUE(body.m_nodes[9].m_x == frozen);
  EXPECT_FALSE(world.forces().blow_up(other).has_value());
  const double speed = (num_steps + 1) * kTimeStep;
  EXPECT_NEAR(static_cast<double>(other.m_nodes[5].m_v.y()), -speed,
              num_steps * kDeformableFaultsEpsilon * speed);
}

TEST(DeformableFaults, NonFiniteStateIsReported) {
  for (const auto& settings : {DeformableWorldSettings{}, implicit_fault_settings()}) {
    for (const auto vector : {&btSoftBody::Node::m_x, &btSoftBody::Node::m_v}) {
      DeformableWorld world(settings);
      btSoftBody& body =
          add_body(world, spring_chain(5, 1), {law("gravity", "acceleration", {0, -9.81, 0})});
      world.step(kTimeStep);
      (body.m_nodes[3].*vector).setX(std::numeric_limits<btScalar>::quiet_NaN());
      world.step(kTimeStep);
      ASSERT_TRUE(world.forces().blow_up(body).has_value());
      EXPECT_EQ(world.forces().blow_up(body)->node, 3);
    }
  }
}

TEST(DeformableFaults, OverflowInTheLinearSolverIsReported) {
  for (const auto& settings : {DeformableWorldSettings{}, implicit_fault_settings()}) {
    DeformableWorld world(settings);
    // Impulses of this damper, or their squares in the linear solver, do not fit the number type.
    const double damping =
        std::min(1e300, 0.9 * static_cast<double>(std::numeric_limits<btScalar>::max()));
    btSoftBody& body =
        add_body(world, spring_chain(4, 1), {law("spring_damping", "damping", {damping})});
    set_velocity(body, 1, {2, 0, 0});
    set_velocity(body, 2, {-2, 0, 0});
    for (int step = 0; step < 3; ++step) world.step(kTimeStep);
    ASSERT_TRUE(world.forces().blow_up(body).has_value());
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isfinite(body.m_nodes[i].m_x.x()));
  }
}

// Upstream: btSoftBody::initializeFaceTree() never returns for a body without links.
TEST(DeformableFaults, NewMassesDoNotHangABodyWithoutLinks) {
  DeformableWorld world({});
  btSoftBody& body =
      add_body(world, spring_chain(3, 0), {law("gravity", "acceleration", {0, -9.81, 0})});
  world.step(kTimeStep);
  body.setMass(1, 0);  // pins the node and asks for new constants
  const btScalar height = body.m_nodes[1].m_x.y();
  body.m_nodes[1].m_v.setZero();
  world.step(kTimeStep);
  EXPECT_EQ(body.m_nodes[1].m_x.y(), height);
  EXPECT_LT(body.m_nodes[2].m_x.y(), height);
}

// Upstream fault g: a node of a deformable anchor moves to its body and leaves m_q behind.
TEST(DeformableFaults, AnchoredNodesTrialPositionFollows) {
  DeformableWorld world({});
  btSoftBody& body = add_body(world, spring_chain(2, 0), {law("tension", "stiffness", {1.0})});
  auto shape = std::make_unique<btSphereShape>(btScalar(0.1));
  auto rigid = std::make_unique<btRigidBody>(btScalar(1), nullptr, shape.get(), btVector3(1, 1, 1));
  rigid->setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 1, 0)));
  btRigidBody& ball = world.add(std::move(rigid), std::move(shape));
  body.appendDeformableAnchor(0, &ball);
  for (int step = 0; step < 10; ++step) {
    world.step(kTimeStep);
    EXPECT_TRUE(body.m_nodes[0].m_q == body.m_nodes[0].m_x);
  }
  EXPECT_LT(body.m_nodes[0].m_x.y(), btScalar(0));  // the ball falls and takes it along
}

}  // namespace
}  // namespace weft::bridge
