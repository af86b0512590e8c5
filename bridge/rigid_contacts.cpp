#include <weft/bridge/rigid_contacts.hpp>

#include <optional>

#include <Eigen/Core>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <weft/custom_forces/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

struct Box {
  btVector3 low;
  btVector3 high;
  [[nodiscard]] bool meets(const btVector3& a, const btVector3& b) const {
    btVector3 least = a;
    btVector3 most = a;
    least.setMin(b);
    most.setMax(b);
    for (int k = 0; k < 3; ++k) {
      if (least[k] > high[k] || most[k] < low[k]) return false;
    }
    return true;
  }
};

Box box_of(const btCollisionObjectWrapper& object, btScalar growth) {
  Box box;
  object.getCollisionShape()->getAabb(object.getWorldTransform(), box.low, box.high);
  const btVector3 grow(growth, growth, growth);
  return {box.low - grow, box.high + grow};
}

/// Plane through the first surface on the way from one place to another.
std::optional<RigidContact> stop_on_the_way(const btCollisionObjectWrapper& object,
                                            const btVector3& from, const btVector3& to,
                                            btScalar margin) {
  btCollisionWorld::ClosestRayResultCallback hit(from, to);
  // Bullet's default test of a ray with a convex shape passes through a box of 2 cm in one of six
  // cases that start within 6 cm of it; this one in none.
  hit.m_flags |= btTriangleRaycastCallback::kF_UseGjkConvexCastRaytest;
  btCollisionWorld::rayTestSingle(btTransform(btQuaternion::getIdentity(), from),
                                  btTransform(btQuaternion::getIdentity(), to),
                                  const_cast<btCollisionObject*>(object.getCollisionObject()),
                                  object.getCollisionShape(), object.getWorldTransform(), hit);
  if (!hit.hasHit() || !(hit.m_hitNormalWorld.length2() > 0)) return std::nullopt;
  RigidContact contact;
  contact.normal = hit.m_hitNormalWorld.normalized();
  if (btDot(contact.normal, to - from) > 0) contact.normal = -contact.normal;
  contact.offset = btDot(contact.normal, from.lerp(to, hit.m_closestHitFraction)) + margin;
  return contact;
}

using Place = Vector3<double>;

Place in_double(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

struct Distance {
  double distance;  ///< [m], signed
  Place out;        ///< unit vector out of the shape
};

/// Balls and boxes, whose distance takes no field: exactly, and from several threads at the same time. A box is as
/// large as with its margin. In the shape's frame.
std::optional<Distance> exact_distance(const btCollisionShape& shape, const Place& local) {
  if (shape.getShapeType() == SPHERE_SHAPE_PROXYTYPE) {
    const double length = local.norm();
    const auto radius = static_cast<double>(static_cast<const btSphereShape&>(shape).getRadius());
    return Distance{length - radius, length > 0 ? Place(local / length) : Place(0, 1, 0)};
  }
  if (shape.getShapeType() != BOX_SHAPE_PROXYTYPE) return std::nullopt;
  const Place half = in_double(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
  const Place beyond = local.cwiseAbs() - half;
  Eigen::Index axis = 0;
  const double deepest = beyond.maxCoeff(&axis);
  Place out = Place::Zero();
  if (deepest <= 0) {
    out[axis] = local[axis] < 0 ? -1 : 1;
    return Distance{deepest, out};
  }
  for (int k = 0; k < 3; ++k) {
    if (beyond[k] > 0) out[k] = local[k] < 0 ? -beyond[k] : beyond[k];
  }
  const double distance = out.norm();
  return Distance{distance, out / distance};
}

/// In double precision: the ground may be a box of many metres, of which a place is a millionth.
std::optional<RigidContact> near_exactly(const btCollisionObjectWrapper& object,
                                         const btVector3& place, btScalar margin) {
  const btTransform& frame = object.getWorldTransform();
  Matrix3<double> turn;
  for (int k = 0; k < 3; ++k) turn.row(k) = in_double(frame.getBasis().getRow(k));
  const Place world = in_double(place);
  const Place local = turn.transpose() * (world - in_double(frame.getOrigin()));
  const auto exact = exact_distance(*object.getCollisionShape(), local);
  if (!exact || exact->distance >= 2 * static_cast<double>(margin)) return std::nullopt;
  const Place out = turn * exact->out;
  RigidContact contact;
  contact.normal.setValue(static_cast<btScalar>(out.x()), static_cast<btScalar>(out.y()),
                          static_cast<btScalar>(out.z()));
  // Of the normal as it is rounded, so that the plane is where it should be for this place.
  contact.offset = static_cast<btScalar>(in_double(contact.normal).dot(world) - exact->distance +
                                         static_cast<double>(margin));
  return contact;
}

std::optional<RigidContact> near_surface(const btSoftBody& body,
                                         const btCollisionObjectWrapper& object,
                                         const btVector3& place, btScalar margin) {
  if (!needs_distance_field(*object.getCollisionShape())) {
    return near_exactly(object, place, margin);
  }
  btSoftBody::sCti found;
  if (!body.checkContact(&object, place, 2 * margin, found)) return std::nullopt;
  RigidContact contact;
  contact.normal = found.m_normal;
  contact.offset = -found.m_offset - margin;  // Bullet's plane is where it looked, at 2 margins
  return contact;
}

}  // namespace

bool needs_distance_field(const btCollisionShape& shape) {
  return !exact_distance(shape, Place::Zero());
}

void add_rigid_contacts(const btSoftBody& body, const btCollisionObjectWrapper& object,
                        btScalar time_step, std::vector<RigidContact>& contacts) {
  const btCollisionObject& collision_object = *object.getCollisionObject();
  if (!collision_object.hasContactResponse()) return;
  const btRigidBody* const rigid = btRigidBody::upcast(&collision_object);
  // Bullet moves a dynamic body only after it has looked for contacts; a kinematic one stands where
  // it ends already.
  const bool is_still_to_move = rigid != nullptr && !rigid->isStaticOrKinematicObject();
  const btScalar margin = body.getCollisionShape()->getMargin();
  const Box box = box_of(object, 2 * margin);
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im <= 0 || node.m_battach != 0) continue;
    btVector3 motion(0, 0, 0);
    if (rigid != nullptr) {
      motion =
          time_step * rigid->getVelocityInLocalPoint(node.m_x - rigid->getCenterOfMassPosition());
    }
    const btVector3 from = is_still_to_move ? node.m_q : node.m_q + motion;
    const btVector3 to = is_still_to_move ? node.m_x - motion : node.m_x;
    if (!box.meets(from, to)) continue;
    std::optional<RigidContact> contact;
    if ((to - from).length2() > margin * margin) {
      contact = stop_on_the_way(object, from, to, margin);
    }
    if (!contact) contact = near_surface(body, object, to, margin);
    if (!contact) continue;
    contact->node = i;
    contact->motion = motion;
    contact->object = &collision_object;
    contact->shape = object.getCollisionShape();
    if (is_still_to_move) contact->offset += btDot(contact->normal, motion);
    contacts.push_back(*contact);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
