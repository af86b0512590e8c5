#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/core/parallel/threads.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

// Large enough for threads within the body; with contacts, a body that yields, dampers and bending.
TEST(FastBodyThreads, ChangeNoBit) {
  const auto run = [](int num_threads) {
    return with_threads(num_threads, [&] {
      EXPECT_EQ(weft::num_threads(), num_threads);
      Scene scene(cloth(50, 1, 0.23),
                  {kGravity, law("tension", "stiffness", 500), law("spring_damping", "damping", 1),
                   law("hinge_torsion", "rigidity", 1e-4)},
                  0.5, {.solver = {.newton_iterations = 6}, .may_sleep = false});
      scene.add(std::make_shared<btSphereShape>(btScalar(0.2)), 0, at(0, 0, 0));
      scene.add(std::make_shared<btSphereShape>(btScalar(0.1)), 0.3, at(0.3, 0.35, 0));
      scene.step(10);
      EXPECT_GT(scene.solver().num_contacts(scene.body()), 100);
      return scene.positions();
    });
  };
  const Matrix3X<double> alone = run(1);
  for (const int num_threads : {2, 4}) EXPECT_EQ(run(num_threads), alone) << num_threads;
}

}  // namespace
}  // namespace weft::bridge
