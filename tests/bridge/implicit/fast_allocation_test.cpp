// A step of a fast body takes no memory after the first ones.
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "tests/support/allocation_counter.hpp"

namespace weft::bridge {
namespace {

/// Allocations in 10 steps after 20, of a cloth that hangs from two corners or has fallen on a box.
long allocations(bool is_hung) {
  ClothGrid grid;
  grid.nodes = {60, 60};  // more than one task
  grid.center = {0, 0.02, 0};
  ClothMesh mesh = make_cloth_grid(grid);
  if (is_hung) mesh.pinned = {0, 59};
  SoftWorld world(SoftWorldSettings{});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {.collision_margin = 0.01}));
  EXPECT_FALSE(world.solver().attach_fast(body, mesh,
                                          {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
                                           {"tension", {}, {{"stiffness", {500.0}}}},
                                           {"hinge_torsion", {}, {{"rigidity", {0.001}}}}},
                                          {.may_sleep = false}));
  if (!is_hung) {
    auto box = std::make_shared<btBoxShape>(btVector3(2, btScalar(0.1), 2));
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, box.get());
    info.m_startWorldTransform.setOrigin(btVector3(0, btScalar(-0.1), 0));
    world.add(std::make_unique<btRigidBody>(info), box);
  }
  for (int step = 0; step < 20; ++step) world.step(1.0 / 60);
  EXPECT_EQ(world.solver().num_contacts(body) > 0, !is_hung);
  const long before = test::num_allocations();
  EXPECT_GT(before, 0);  // it does count
  for (int step = 0; step < 10; ++step) world.step(1.0 / 60);
  return test::num_allocations() - before;
}

TEST(FastAllocation, IsZeroInTheAir) {
  for (const int threads : {1, 2}) {
    EXPECT_EQ(with_threads(threads, [] { return allocations(true); }), 0) << threads;
  }
}

TEST(FastAllocation, IsZeroOnABox) {
  for (const int threads : {1, 2}) {
    EXPECT_EQ(with_threads(threads, [] { return allocations(false); }), 0) << threads;
  }
}

}  // namespace
}  // namespace weft::bridge
