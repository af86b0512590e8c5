#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

namespace weft::recorder {

/// A program's own world with Bullet's own solver, or another one.
class SmallWorld {
 public:
  explicit SmallWorld(btSoftBodySolver* solver = nullptr)
      : world_(&dispatcher_, &broadphase_, &constraints_, &configuration_, solver) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    world_.getWorldInfo().m_gravity.setValue(0, btScalar(-9.81), 0);
    world_.getWorldInfo().m_sparsesdf.Initialize();
  }
  ~SmallWorld() {
    for (const auto& body : rigids_) world_.removeRigidBody(body.get());
    for (const auto& body : cloths_) world_.removeSoftBody(body.get());
  }
  SmallWorld(const SmallWorld&) = delete;
  SmallWorld& operator=(const SmallWorld&) = delete;

  btSoftBody& add(std::unique_ptr<btSoftBody> body) {
    cloths_.push_back(std::move(body));
    world_.addSoftBody(cloths_.back().get());
    return *cloths_.back();
  }
  /// A patch of Bullet's own, 2 m x 2 m at the given height, that weighs 0.5 kg.
  btSoftBody& add_patch(int nodes, double height) {
    const auto y = static_cast<btScalar>(height);
    btSoftBody* patch = btSoftBodyHelpers::CreatePatch(world_.getWorldInfo(), btVector3(-1, y, -1),
                                                       btVector3(1, y, -1), btVector3(-1, y, 1),
                                                       btVector3(1, y, 1), nodes, nodes, 0, true);
    patch->setTotalMass(btScalar(0.5));
    return add(std::unique_ptr<btSoftBody>(patch));
  }
  /// mass [kg]; 0: fixed.
  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, double mass, const btTransform& place) {
    btVector3 inertia(0, 0, 0);
    const auto weight = static_cast<btScalar>(mass);
    if (mass > 0) shape->calculateLocalInertia(weight, inertia);
    rigids_.push_back(std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(weight, nullptr, shape.get(), inertia)));
    shapes_.push_back(std::move(shape));
    rigids_.back()->setWorldTransform(place);
    world_.addRigidBody(rigids_.back().get());
    return *rigids_.back();
  }
  void step(double time_step) { world_.stepSimulation(static_cast<btScalar>(time_step), 0); }
  [[nodiscard]] btSoftBodyWorldInfo& info() { return world_.getWorldInfo(); }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver constraints_;
  btSoftRigidDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> rigids_;
  std::vector<std::unique_ptr<btSoftBody>> cloths_;
};

inline btTransform at(double x, double y, double z,
                      const btQuaternion& turn = btQuaternion::getIdentity()) {
  return btTransform(turn, btVector3(static_cast<btScalar>(x), static_cast<btScalar>(y),
                                     static_cast<btScalar>(z)));
}

}  // namespace weft::recorder
