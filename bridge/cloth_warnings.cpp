// Warnings of forces::find_warnings() for a body in its world.
// Tested by tests/bridge/cloth_warnings_test.cpp.
#include <weft/bridge/cloth.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/implicit/stiffness_limit.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Half of the smallest and of the middle extent in the shape's own frame [m], of a compound the least of its children; infinity for
/// ground.
struct HalfExtents {
  double least = std::numeric_limits<double>::infinity();
  double middle = std::numeric_limits<double>::infinity();
};

HalfExtents half_extents(const btCollisionShape& shape) {
  HalfExtents half;
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int child = 0; child < compound.getNumChildShapes(); ++child) {
      const HalfExtents one = half_extents(*compound.getChildShape(child));
      half = {std::min(half.least, one.least), std::min(half.middle, one.middle)};
    }
    return half;
  }
  if (!shape.isConvex()) return half;
  btVector3 lower;
  btVector3 upper;
  shape.getAabb(btTransform::getIdentity(), lower, upper);
  Vector3<double> extents = from_bullet(upper - lower) / 2;
  std::sort(extents.begin(), extents.end());
  return {extents[0], extents[1]};
}

std::vector<forces::SetUpCollider> colliders_of(const btCollisionWorld& world) {
  std::vector<forces::SetUpCollider> colliders;
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const btCollisionObject& object = *objects[i];
    if (object.getInternalType() == btCollisionObject::CO_SOFT_BODY) continue;
    const HalfExtents half = half_extents(*object.getCollisionShape());
    forces::SetUpCollider collider{.name = std::string(object.getCollisionShape()->getName()) +
                                           ", object " + std::to_string(i) + " of the world",
                                   .least_half_extent = half.least,
                                   .middle_half_extent = half.middle};
    if (const btRigidBody* const body = btRigidBody::upcast(&object)) {
      if (body->getInvMass() > 0) collider.mass = 1 / static_cast<double>(body->getInvMass());
      collider.speed = static_cast<double>(body->getLinearVelocity().length());
    }
    colliders.push_back(std::move(collider));
  }
  return colliders;
}

double fastest(const btSoftBody& body) {
  btScalar squared = 0;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    squared = std::max(squared, body.m_nodes[i].m_v.length2());
  }
  return std::sqrt(static_cast<double>(squared));
}

}  // namespace

std::vector<forces::SetUpWarning> Cloth::warnings(const btCollisionWorld& world,
                                                  double time_step) const {
  if (!has_laws()) return {};
  const auto& source = solver_->find(*body_)->source;
  if (!source) return {};
  const ContactEntry* const entry = solver_->find_contact_entry(*body_);
  const bool meets_itself = entry != nullptr && entry->contact.settings().with_itself;
  return forces::find_warnings(
      {.mesh = source->mesh,
       .laws = source->laws,
       .time_step = time_step,
       .is_always_stable = solver_->is_fast(*body_),
       .most_stiffness = solver_->is_fast(*body_) ? static_cast<double>(kMostStiffness)
                                                  : std::numeric_limits<double>::infinity(),
       .is_single_precision = sizeof(btScalar) == sizeof(float),
       .margin = static_cast<double>(body_->getCollisionShape()->getMargin()),
       .speed = fastest(*body_),
       .layer_distance = meets_itself ? entry->contact.settings().self_thickness : 0,
       .meets_cloth = entry != nullptr && entry->contact.settings().with_others,
       .keeps_layers_apart = solver_->is_fast(*body_),
       .world_gravity = from_bullet(body_->m_worldInfo->m_gravity),
       .colliders = colliders_of(world)});
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
