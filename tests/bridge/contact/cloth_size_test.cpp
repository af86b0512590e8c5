// Cloth from the size of a stamp to that of a sail behaves alike for its size.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

/// A cloth of a size [m] and its margin, a hundredth of that, dropped from half its size.
struct Dropped {
  SoftWorld world{SoftWorldSettings{}};
  btSoftBody* body = nullptr;

  Dropped(double size, std::shared_ptr<btCollisionShape> ground, double depth) {
    const double mass = 0.25 * size * size;
    const ClothMesh mesh = cloth(11, size, 0.5 * size, mass);
    body = &world.add(make_cloth_body(world.info(), mesh, {.collision_margin = 0.01 * size}));
    EXPECT_FALSE(world.solver().attach_fast(
        *body, mesh, {kGravity, law("tension", "stiffness", 2000 * mass / size)}, {}));
    add_rigid(world, std::move(ground), 0, at(0, -depth, 0));
  }
  [[nodiscard]] double lowest() const {
    double least = 1e9;
    for (int i = 0; i < body->m_nodes.size(); ++i) {
      least = std::min(least, static_cast<double>(body->m_nodes[i].m_x.y()));
    }
    return least;
  }
  [[nodiscard]] double highest() const {
    double most = -1e9;
    for (int i = 0; i < body->m_nodes.size(); ++i) {
      most = std::max(most, static_cast<double>(body->m_nodes[i].m_x.y()));
    }
    return most;
  }
};

TEST(ClothSize, ClothOfAnySizeLiesItsMarginAboveTheGround) {
  for (const double size : {0.01, 0.02, 0.03, 0.1, 1.0, 10.0, 100.0}) {
    for (const double time_step : {1.0 / 30, 1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
      for (const bool is_box : {true, false}) {
        std::shared_ptr<btCollisionShape> ground;
        if (is_box) {
          ground = std::make_shared<btBoxShape>(vector(3 * size, size, 3 * size));
        } else {
          ground = std::make_shared<btStaticPlaneShape>(vector(0, 1, 0), btScalar(size));
        }
        Dropped scene(size, ground, size);
        const double duration = std::max(0.5, 3 * std::sqrt(size / 9.81)) + 0.5;
        for (double time = 0; time < duration; time += time_step) scene.world.step(time_step);
        const double margin = 0.01 * size;
        EXPECT_NEAR(scene.lowest(), margin, 1e-3 * size)
            << size << " m, " << time_step << (is_box ? " s, box" : " s, plane");
        EXPECT_NEAR(scene.highest(), margin, 1e-3 * size)
            << size << " m, " << time_step << (is_box ? " s, box" : " s, plane");
      }
    }
  }
}

}  // namespace
}  // namespace weft::bridge
