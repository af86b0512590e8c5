#pragma once

#include <memory>
#include <utility>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/soft_world.hpp>

namespace weft::bridge {

inline btVector3 vector(double x, double y, double z) {
  return to_bullet(Vector3<double>(x, y, z));
}

/// A place without a turn [m].
inline btTransform at(double x, double y, double z) {
  return btTransform(btQuaternion::getIdentity(), vector(x, y, z));
}

/// An object that never sleeps. Mass 0 [kg]: it does not move.
inline btRigidBody& add_rigid(SoftWorld& world, std::shared_ptr<btCollisionShape> shape,
                              double mass, const btTransform& place) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape.get(),
                                                inertia);
  info.m_startWorldTransform = place;
  info.m_friction = 1;
  auto rigid = std::make_unique<btRigidBody>(info);
  rigid->setActivationState(DISABLE_DEACTIVATION);
  return world.add(std::move(rigid), std::move(shape));
}

}  // namespace weft::bridge
