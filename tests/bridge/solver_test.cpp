#include <cmath>
#include <limits>

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::bridge {
namespace {

constexpr double kEpsilon = std::numeric_limits<btScalar>::epsilon();
constexpr double kTimeStep = 1.0 / 128;  // [s] exact in single precision

ClothMesh free_cloth() {
  ClothGrid grid;
  grid.nodes = {8, 8};
  grid.total_mass = 0.2;
  return make_cloth_grid(grid);
}

forces::LawSpecification law(const std::string& id, const std::string& parameter,
                             std::vector<double> values) {
  return {id, {}, {{parameter, std::move(values)}}};
}

forces::LawSet<btScalar> laws(const ClothMesh& mesh,
                              const std::vector<forces::LawSpecification>& specifications) {
  forces::LawSet<btScalar> set;
  for (const auto& specification : specifications) {
    set.add(forces::make_law<btScalar>(specification, mesh));
  }
  return set;
}

TEST(SoftBodySolver, FreeFallIsTheSymplecticEulerParabola) {
  const ClothMesh mesh = free_cloth();
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  world.solver().attach(body, laws(mesh, {law("gravity", "acceleration", {0, -9.81, 0})}),
                        mesh.masses.cast<btScalar>());
  const int num_steps = 100;
  for (int step = 0; step < num_steps; ++step) world.step(kTimeStep);
  const double drop = 9.81 * kTimeStep * kTimeStep * num_steps * (num_steps + 1) / 2;
  // Bullet derives the velocity from positions every step: an error of eps x / h per step,
  // integrated twice.
  const double tolerance = num_steps * num_steps * kEpsilon * drop;
  EXPECT_NEAR(static_cast<double>(body.m_nodes[10].m_x.y()), -drop, tolerance);
}

TEST(SoftBodySolver, VelocityLawsActAfterTheProjection) {
  const ClothMesh mesh = free_cloth();
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_v.setValue(1, 0, 0);
  const double rate = 2.0;
  world.solver().attach(body, laws(mesh, {law("velocity_damping", "rate", {rate})}),
                        mesh.masses.cast<btScalar>());
  const int num_steps = 64;
  for (int step = 0; step < num_steps; ++step) world.step(kTimeStep);
  const double expected = std::exp(-rate * kTimeStep * num_steps);
  const double position_noise = kEpsilon / kTimeStep;
  EXPECT_NEAR(static_cast<double>(body.m_nodes[3].m_v.x()), expected, num_steps * position_noise);
}

TEST(SoftBodySolver, LawsKnowTheTimeSinceTheyWereAttached) {
  ClothMesh mesh = free_cloth();
  mesh.node_sets = {{"hand", {5}}};
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  world.step(kTimeStep);
  const double speed = 0.5;
  const double stiffness = 4 * mesh.masses[5];  // w^2 = 4 / s^2
  const forces::LawSpecification drive{
      "drive", {}, {{"stiffness", {stiffness}}, {"velocity", {0, speed, 0}}}};
  world.solver().attach(body, mesh, {drive});
  const int num_steps = 128;
  double x = 0, v = 0;
  for (int step = 0; step < num_steps; ++step) {
    world.step(kTimeStep);
    v += kTimeStep * 4 * (speed * (step * kTimeStep) - x);
    x += kTimeStep * v;
  }
  // An error of eps x / h per step in the velocity, integrated.
  const double tolerance = num_steps * num_steps * kEpsilon * x;
  EXPECT_GT(x, 0.1);
  EXPECT_NEAR(static_cast<double>(body.m_nodes[5].m_x.y()), x, tolerance);
}

TEST(SoftBodySolver, PinnedNodesMoveWithTheirVelocity) {
  ClothMesh mesh = free_cloth();
  mesh.pinned = {0, 7};
  mesh.pinned_velocities = Matrix3X<double>::Zero(3, 2);
  mesh.pinned_velocities.col(1) << 0.25, -0.5, 0;
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  world.solver().attach(body, mesh, {law("tension", "stiffness", {5.0})});
  const btVector3 start = body.m_nodes[7].m_x;
  const btVector3 still = body.m_nodes[0].m_x;
  const int num_steps = 128;
  for (int step = 0; step < num_steps; ++step) {
    set_pinned_velocities(mesh, body);
    world.step(kTimeStep);
  }
  const double time = num_steps * kTimeStep;
  const double tolerance = num_steps * kEpsilon;  // of positions up to 1 m
  const btVector3 way = body.m_nodes[7].m_x - start;
  EXPECT_NEAR(static_cast<double>(way.x()), 0.25 * time, tolerance);
  EXPECT_NEAR(static_cast<double>(way.y()), -0.5 * time, tolerance);
  EXPECT_EQ(body.m_nodes[0].m_x, still);
}

TEST(SoftBodySolver, DetachedBodyIsBulletsAgain) {
  const ClothMesh mesh = free_cloth();
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  world.solver().attach(body, laws(mesh, {law("gravity", "acceleration", {0, -9.81, 0})}),
                        mesh.masses.cast<btScalar>());
  EXPECT_TRUE(world.solver().has_laws(body));
  world.solver().detach(body);
  EXPECT_FALSE(world.solver().has_laws(body));
  world.step(kTimeStep);
  EXPECT_EQ(body.m_nodes[0].m_v.y(), btScalar(0));
}

TEST(SoftBodySolver, WrongUseIsRefused) {
  const ClothMesh mesh = free_cloth();
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  EXPECT_THROW(world.solver().attach(body, {}, VectorX<btScalar>::Ones(3)), InvalidArgument);
  world.solver().attach(body, {}, mesh.masses.cast<btScalar>());
  EXPECT_THROW(world.solver().attach(body, {}, mesh.masses.cast<btScalar>()), InvalidArgument);
}

TEST(SoftBodySolver, LawsOfAnotherMeshAreRefusedAtOnce) {
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), free_cloth(), {}));
  ClothGrid grid;
  grid.nodes = {5, 5};
  const ClothMesh other = make_cloth_grid(grid);
  const VectorX<btScalar> masses = free_cloth().masses.cast<btScalar>();
  EXPECT_THROW(
      world.solver().attach(body, laws(other, {law("tension", "stiffness", {1.0})}), masses),
      InvalidArgument);
  EXPECT_FALSE(world.solver().has_laws(body));
  body.m_cfg.timescale = btScalar(0.5);
  EXPECT_THROW(world.solver().attach(body, {}, masses), InvalidArgument);
}

TEST(SoftBodySolver, ExplosionIsReportedAndFrozen) {
  const ClothMesh mesh = free_cloth();
  SoftWorld world({});
  auto shape = std::make_unique<btSphereShape>(btScalar(1));
  auto collider = std::make_unique<btRigidBody>(btScalar(0), nullptr, shape.get());
  world.add(std::move(collider), std::move(shape));
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  // A thousand times beyond the stable step: every mode grows at once.
  world.solver().attach(body, laws(mesh, {law("tension", "stiffness", {1e6})}),
                        mesh.masses.cast<btScalar>());
  body.m_nodes[9].m_x += btVector3(btScalar(0.01), 0, 0);
  for (int step = 0; step < 200; ++step) world.step(kTimeStep);
  const auto blow_up = world.solver().blow_up(body);
  ASSERT_TRUE(blow_up.has_value());
  EXPECT_FALSE(blow_up->reason.empty());
  EXPECT_GE(blow_up->node, 0);
  EXPECT_LT(blow_up->node, mesh.num_nodes());
}

TEST(SoftBodySolver, NonFiniteStateIsReportedAndDoesNotReachBullet) {
  const ClothMesh mesh = free_cloth();
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  world.solver().attach(body, laws(mesh, {law("gravity", "acceleration", {0, -9.81, 0})}),
                        mesh.masses.cast<btScalar>());
  body.m_nodes[7].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  world.step(kTimeStep);
  ASSERT_TRUE(world.solver().blow_up(body).has_value());
  EXPECT_EQ(world.solver().blow_up(body)->node, 7);
}

TEST(BulletGuard, ProgramCompiledForAnotherBulletIsRefused) {
  BulletLayout other = bullet_layout_here();
  other.scalar_size = other.scalar_size == 8 ? 4 : 8;
  EXPECT_THROW(require_matching_bullet(other), Error);
  EXPECT_NO_THROW(require_matching_bullet(bullet_layout_here()));
}

}  // namespace
}  // namespace weft::bridge
