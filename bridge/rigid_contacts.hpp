#pragma once

#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// A node in front of a rigid surface: normal . x >= offset at the end of the step.
struct RigidContact {
  int node = 0;
  btVector3 normal{0, 0, 0};  ///< out of the object
  btScalar offset = 0;        ///< [m]
  btVector3 motion{0, 0, 0};  ///< of the surface during the step [m]
  const btCollisionObject* object = nullptr;
  const btCollisionShape* shape = nullptr;  ///< the part of the object that it is with
};

/// Appends the contacts of a body's nodes with an object, between btSoftBody::predictMotion and
/// solveConstraints of a step of time_step [s].
///
/// Nodes are looked up in Bullet's distance field of the shape at the predicted place, as Bullet does,
/// up to twice the collision margin. A node that travels farther than the margin is followed along
/// its way, relative to the object, and stopped at the surface that it meets first: however thin the
/// object, it is not shot through. Pinned and anchored nodes are left out.
void add_rigid_contacts(const btSoftBody& body, const btCollisionObjectWrapper& object,
                        btScalar time_step, std::vector<RigidContact>& contacts);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
