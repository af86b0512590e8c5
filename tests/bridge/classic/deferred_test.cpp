// Deferred forces in Bullet's world change no bit, survive whatever happens between steps, and
// leave the main thread free.
#include <cstring>
#include <vector>

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::bridge {
namespace {

constexpr double kDeferredTimeStep = 1.0 / 128;  // [s] exact in single precision
constexpr int kNumSteps = 100;

const std::vector<forces::LawSpecification> kLaws = {
    {"tension", {}, {{"stiffness", {0.5}}}},
    {"spring_damping", {}, {{"damping", {0.0005}}}},
    {"velocity_damping", {}, {{"rate", {0.5}}}},
    {"gravity", {}, {{"acceleration", {0, -9.81, 0}}}},
};

/// A cloth that falls onto a sphere.
class FallingCloth {
 public:
  explicit FallingCloth(bool is_deferred) {
    auto shape = std::make_unique<btSphereShape>(btScalar(0.5));
    auto sphere = std::make_unique<btRigidBody>(btScalar(0), nullptr, shape.get());
    world_.add(std::move(sphere), std::move(shape));
    ClothGrid grid;
    grid.nodes = {20, 20};
    grid.size = {2, 2};
    grid.center = {0, 0.7, 0};
    mesh_ = make_cloth_grid(grid);
    body_ = &world_.add(make_cloth_body(world_.info(), mesh_, {}));
    world_.solver().attach(*body_, mesh_, kLaws);
    world_.solver().set_deferred(is_deferred);
  }

  void step() { world_.step(kDeferredTimeStep); }
  [[nodiscard]] btSoftBody& body() { return *body_; }
  [[nodiscard]] SoftWorld& world() { return world_; }
  [[nodiscard]] const ClothMesh& mesh() const { return mesh_; }
  [[nodiscard]] long num_recomputed() { return world_.solver().num_recomputed(*body_); }

 private:
  SoftWorld world_{{}};
  ClothMesh mesh_;
  btSoftBody* body_ = nullptr;
};

testing::AssertionResult same_bits(btSoftBody& a, btSoftBody& b) {
  for (int i = 0; i < a.m_nodes.size(); ++i) {
    if (std::memcmp(&a.m_nodes[i].m_x, &b.m_nodes[i].m_x, 3 * sizeof(btScalar)) != 0 ||
        std::memcmp(&a.m_nodes[i].m_v, &b.m_nodes[i].m_v, 3 * sizeof(btScalar)) != 0) {
      return testing::AssertionFailure() << "node " << i << " differs";
    }
  }
  return testing::AssertionSuccess();
}

/// Steps both worlds; meddle(body, step) acts on each between steps.
template <class Meddle>
void expect_same_run(FallingCloth& direct, FallingCloth& deferred, const Meddle& meddle) {
  for (int step = 0; step < kNumSteps; ++step) {
    direct.step();
    deferred.step();
    ASSERT_TRUE(same_bits(direct.body(), deferred.body())) << "step " << step;
    meddle(direct.body(), step);
    meddle(deferred.body(), step);
  }
  ASSERT_FALSE(direct.world().solver().blow_up(direct.body())) << "the scene itself must be sound";
}

TEST(Deferred, ChangesNoBit) {
  FallingCloth direct(false);
  FallingCloth deferred(true);
  expect_same_run(direct, deferred, [](btSoftBody&, int) {});
  EXPECT_EQ(deferred.num_recomputed(), 0);
}

TEST(Deferred, NodesMovedBetweenStepsAreNoticed) {
  FallingCloth direct(false);
  FallingCloth deferred(true);
  expect_same_run(direct, deferred, [](btSoftBody& body, int step) {
    if (step == 10) body.m_nodes[7].m_x += btVector3(btScalar(0.01), 0, 0);
    if (step == 20) body.m_nodes[8].m_v += btVector3(0, btScalar(0.5), 0);
    if (step == 30) body.translate(btVector3(0, btScalar(0.1), 0));
  });
  EXPECT_EQ(deferred.num_recomputed(), 3);
}

TEST(Deferred, ForcesOfTheApplicationStillAct) {
  FallingCloth direct(false);
  FallingCloth deferred(true);
  expect_same_run(direct, deferred,
                  [](btSoftBody& body, int) { body.addForce(btVector3(0, btScalar(0.01), 0), 3); });
  EXPECT_EQ(deferred.num_recomputed(), 0) << "a force moves nothing before the step";
}

TEST(Deferred, CanBeSwitchedAtAnyTime) {
  FallingCloth direct(false);
  FallingCloth deferred(true);
  int count = 0;
  expect_same_run(direct, deferred, [&](btSoftBody& body, int step) {
    if (&body == &deferred.body()) deferred.world().solver().set_deferred(step % 3 != 0);
    ++count;
  });
  EXPECT_EQ(count, 2 * kNumSteps);
}

TEST(Deferred, ABodyMayBeDetachedOrDeletedInFlight) {
  FallingCloth cloth(true);
  cloth.step();
  cloth.world().solver().detach(cloth.body());
  cloth.step();
  EXPECT_EQ(cloth.num_recomputed(), 0);

  for (int repetition = 0; repetition < 10; ++repetition) {
    SoftWorld world({});
    world.solver().set_deferred(true);
    auto body = make_cloth_body(world.info(), cloth.mesh(), {});
    world.world().addSoftBody(body.get());
    world.solver().attach(*body, cloth.mesh(), kLaws);
    world.step(kDeferredTimeStep);
    world.world().removeSoftBody(body.get());
    body.reset();             // its forces are in flight
    if (repetition % 2 == 0)  // else the solver goes with them
      world.step(kDeferredTimeStep);
  }
}

TEST(Deferred, AnExplosionIsReportedAsWithout) {
  FallingCloth direct(false);
  FallingCloth deferred(true);
  for (FallingCloth* cloth : {&direct, &deferred}) {
    for (int i = 0; i < 5; ++i) cloth->step();
    cloth->body().m_nodes[9].m_v.setValue(btScalar(1e7), 0, 0);
    for (int i = 0; i < 3; ++i) cloth->step();
  }
  const auto expected = direct.world().solver().blow_up(direct.body());
  const auto found = deferred.world().solver().blow_up(deferred.body());
  ASSERT_TRUE(expected.has_value());
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->node, expected->node);
  EXPECT_EQ(found->reason, expected->reason);
}

}  // namespace
}  // namespace weft::bridge
