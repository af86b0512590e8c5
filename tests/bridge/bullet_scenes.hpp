#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

namespace weft::bridge::testing {

/// A plain Bullet world around a solver; a null solver is Bullet's own default.
class PlainWorld {
 public:
  explicit PlainWorld(btSoftBodySolver* solver);
  ~PlainWorld();
  PlainWorld(const PlainWorld&) = delete;
  PlainWorld& operator=(const PlainWorld&) = delete;

  btSoftBody* add(btSoftBody* body);  ///< takes ownership
  btRigidBody* add_rigid(std::unique_ptr<btCollisionShape> shape, btScalar mass,
                         const btVector3& at);

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraint_solver;
  btSoftRigidDynamicsWorld world;

 private:
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> rigid_bodies_;
  std::vector<std::unique_ptr<btSoftBody>> soft_bodies_;
};

/// A soft-body scene in the manner of Bullet's own demo.
struct BulletScene {
  std::string name;
  std::function<void(PlainWorld&)> build;
};

[[nodiscard]] const std::vector<BulletScene>& bullet_scenes();

/// Every node's position and velocity and every rigid body's transform, after each of num_steps
/// steps.
[[nodiscard]] std::vector<btScalar> run_scene(const BulletScene& scene, btSoftBodySolver* solver,
                                              int num_steps);

}  // namespace weft::bridge::testing
