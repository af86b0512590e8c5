#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

namespace weft::bench {

/// A world as Bullet's soft-body demo has it: a floor at y = -10 m, gravity of 10 m/s^2.
class DemoWorld {
 public:
  static constexpr double kFloor = -10;  // [m] its top

  /// No solver: Bullet's own.
  explicit DemoWorld(btSoftBodySolver* solver);
  ~DemoWorld();
  DemoWorld(const DemoWorld&) = delete;
  DemoWorld& operator=(const DemoWorld&) = delete;

  btSoftBody& add(btSoftBody* body);  ///< takes it over
  btRigidBody& add_rigid(std::unique_ptr<btCollisionShape> shape, double mass,
                         const btVector3& place);
  /// Boxes of 1 m that fall one after the other.
  void add_falling_boxes(int count);
  void add_plate(double mass, double height);
  void add_stair(int num_steps);

  [[nodiscard]] btSoftBodyWorldInfo& info() { return world.getWorldInfo(); }

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world;

 private:
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> rigids_;
  std::vector<std::unique_ptr<btSoftBody>> bodies_;
};

/// A scene of one of the kinds of Bullet's soft-body demo, made from scratch.
struct DemoScene {
  std::string name;
  std::function<void(DemoWorld&)> build;
  bool stays_above_floor = true;  ///< what falls beside it is no fault where there is wind
};

[[nodiscard]] const std::vector<DemoScene>& demo_scenes();

}  // namespace weft::bench
