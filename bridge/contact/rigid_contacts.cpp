#include <weft/bridge/contact/rigid_contacts.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <LinearMath/btTransformUtil.h>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

MotionBox box_of(const btVector3& low, const btVector3& high) {
  return {{low.x(), low.y(), low.z(), 0}, {high.x(), high.y(), high.z(), 0}};
}

/// Bounds the ways of some nodes, at least one.
MotionBox box_of(const btSoftBody& body, std::span<const int> nodes) {
  Four low = four(body.m_nodes[nodes[0]].m_x);
  Four high = low;
  for (const int i : nodes) {
    const Four start = four(body.m_nodes[i].m_q);
    const Four end = four(body.m_nodes[i].m_x);
    low = low.min(start).min(end);
    high = high.max(start).max(end);
  }
  return {{low[0], low[1], low[2], 0}, {high[0], high[1], high[2], 0}};
}

/// Plane through the first surface on the way from one place to another.
std::optional<RigidContact> stop_on_the_way(const Collider& collider, const btVector3& from,
                                            const btVector3& to, btScalar margin) {
  btCollisionWorld::ClosestRayResultCallback hit(from, to);
  // Bullet's default test of a ray with a convex shape passes through a box of 2 cm in one of six
  // cases that start within 6 cm of it; this one in none.
  hit.m_flags |= btTriangleRaycastCallback::kF_UseGjkConvexCastRaytest;
  btCollisionWorld::rayTestSingle(
      btTransform(btQuaternion::getIdentity(), from), btTransform(btQuaternion::getIdentity(), to),
      const_cast<btCollisionObject*>(collider.object), collider.shape, collider.place, hit);
  if (!hit.hasHit() || !(hit.m_hitNormalWorld.length2() > 0)) return std::nullopt;
  RigidContact contact;
  contact.normal = hit.m_hitNormalWorld.normalized();
  if (btDot(contact.normal, to - from) > 0) contact.normal = -contact.normal;
  contact.offset = btDot(contact.normal, from.lerp(to, hit.m_closestHitFraction)) + margin;
  return contact;
}

/// A collider that surface_distance() knows, in double precision: the ground may be a box of many metres, of which a place
/// is a millionth.
class ExactCollider {
 public:
  ExactCollider(const Collider& collider, btScalar margin)
      : collider_(collider),
        margin_(static_cast<double>(margin)),
        origin_(from_bullet(collider.place.getOrigin())) {
    for (int k = 0; k < 3; ++k) turn_.row(k) = from_bullet(collider.place.getBasis().getRow(k));
  }

  /// The contact of a node that goes from one place to another. One that is followed is stopped on its way, unless that
  /// cannot come to the surface: its ends are farther away than it is long.
  [[nodiscard]] std::optional<RigidContact> find(const btVector3& from, const btVector3& to,
                                                 bool is_followed) const {
    const double reach = 2 * margin_;
    const double length =
        is_followed ? (from_bullet(to) - from_bullet(from)).norm() * (1 + kRounding) : 0;
    const SurfaceDistance end = surface_from(to, std::max(reach, length));
    const auto may_be_on_the_way = [&] {
      return end.distance < length && surface_from(from, length).distance + end.distance <= length;
    };
    if (is_followed && may_be_on_the_way()) {
      if (auto contact = stop_on_the_way(collider_, from, to, static_cast<btScalar>(margin_))) {
        return contact;
      }
    }
    if (end.distance >= reach) return std::nullopt;
    RigidContact contact;
    contact.normal = to_bullet((turn_ * end.out).eval());
    // With the normal as it is rounded, so that the plane is where it should be for this place.
    contact.offset = static_cast<btScalar>(from_bullet(contact.normal).dot(from_bullet(to)) -
                                           end.distance + margin_);
    return contact;
  }

 private:
  static constexpr double kRounding = 1e-6;  ///< of ways in single precision
  [[nodiscard]] SurfaceDistance surface_from(const btVector3& place, double reach) const {
    const Vector3<double> local = turn_.transpose() * (from_bullet(place) - origin_);
    return surface_distance(*collider_.shape, collider_.facets, local, reach).value();
  }

  const Collider& collider_;
  double margin_;
  Vector3<double> origin_;
  Matrix3<double> turn_;
};

/// The same in Bullet's distance field of any shape.
std::optional<RigidContact> find_in_field(const btSoftBody& body, const Collider& collider,
                                          const btVector3& from, const btVector3& to,
                                          btScalar margin, bool is_followed) {
  if (is_followed) {
    if (auto contact = stop_on_the_way(collider, from, to, margin)) return contact;
  }
  const btCollisionObjectWrapper object(nullptr, collider.shape, collider.object, collider.place,
                                        -1, -1);
  btSoftBody::sCti found;
  if (!body.checkContact(&object, to, 2 * margin, found)) return std::nullopt;
  RigidContact contact;
  contact.normal = found.m_normal;
  contact.offset = -found.m_offset - margin;  // Bullet's plane is where it looked, at 2 margins
  return contact;
}

/// [m] No node among those of a box moves farther with the body in a step.
btScalar largest_motion(const btRigidBody& rigid, const MotionBox& nodes, btScalar time_step) {
  btScalar reach2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const btScalar center = rigid.getCenterOfMassPosition()[static_cast<int>(k)];
    const btScalar reach =
        std::max(std::abs(nodes.low[k] - center), std::abs(nodes.high[k] - center));
    reach2 += reach * reach;
  }
  return time_step * (rigid.getLinearVelocity().length() +
                      rigid.getAngularVelocity().length() * std::sqrt(reach2));
}

/// The same with a motion that is known: the corner that goes farthest.
btScalar largest_motion(const btTransform& back, const MotionBox& nodes) {
  btScalar most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [&](int axis) {
      const auto k = static_cast<std::size_t>(axis);
      return (corner >> axis & 1) != 0 ? nodes.high[k] : nodes.low[k];
    };
    const btVector3 place(side(0), side(1), side(2));
    most = std::max(most, (back * place - place).length());
  }
  return most;
}

}  // namespace

Collider make_collider(const btCollisionObjectWrapper& object, const HullFacets* facets, int number,
                       btScalar time_step) {
  Collider collider{object.getCollisionObject(), object.getCollisionShape(),
                    object.getWorldTransform(), facets, number};
  if (const btRigidBody* const rigid = movable(collider.object)) {
    btTransform end;
    btTransformUtil::integrateTransform(rigid->getWorldTransform(), rigid->getLinearVelocity(),
                                        rigid->getAngularVelocity(), time_step, end);
    collider.object_place = rigid->getWorldTransform();
    collider.motion = end * collider.object_place.inverse();
  }
  return collider;
}

btRigidBody* movable(const btCollisionObject* object) {
  auto* rigid = const_cast<btRigidBody*>(btRigidBody::upcast(object));
  return rigid != nullptr && !rigid->isStaticOrKinematicObject() ? rigid : nullptr;
}

void SweptNodes::update(const btSoftBody& body, fast::WorkerTeam* team) {
  if (is_of_now_) return;
  is_of_now_ = true;
  if (groups_.num_nodes() != body.m_nodes.size()) {
    groups_.arrange(body);
    groups_.sort();
  }
  boxes_.resize(groups_.size());
  const auto enclose = [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      boxes_[g] = box_of(body, groups_[g]);
    }
  };
  if (const std::size_t num_parts = num_parts_for(team); num_parts > 1) {
    team->run(static_cast<int>(num_parts), [&](int part) {
      const auto p = static_cast<std::size_t>(part);
      enclose(boxes_.size() * p / num_parts, boxes_.size() * (p + 1) / num_parts);
    });
  } else {
    enclose(0, boxes_.size());
  }
  all_ = MotionBox::nowhere();
  for (const MotionBox& box : boxes_) all_.include(box);
}

void add_rigid_contacts(const btSoftBody& body, SweptNodes& ways, const Collider& collider,
                        btScalar time_step, PinnedNodes pinned, std::vector<RigidContact>& contacts,
                        fast::WorkerTeam* team) {
  if (!collider.object->hasContactResponse()) return;
  // Where the step begins is what Bullet knows of a dynamic body, and where it ends of a kinematic one.
  const btRigidBody* const dynamic = movable(collider.object);
  const btRigidBody* led = dynamic == nullptr ? btRigidBody::upcast(collider.object) : nullptr;
  if (led != nullptr && led->getLinearVelocity().isZero() && led->getAngularVelocity().isZero()) {
    led = nullptr;
  }
  const btTransform back = collider.motion.inverse();
  const btScalar margin = body.getCollisionShape()->getMargin();
  btVector3 low;
  btVector3 high;
  collider.shape->getAabb(collider.place, low, high);
  const MotionBox box = box_of(low, high).grown(2 * margin);
  MotionBox reached = box;
  if (dynamic != nullptr) reached = box.grown(largest_motion(back, ways.all()));
  if (led != nullptr) reached = box.grown(largest_motion(*led, ways.all(), time_step));
  if (!meet(reached, ways.all())) return;
  const bool looks_at_pinned =
      pinned == PinnedNodes::kWithDynamicObjects && !collider.object->isStaticOrKinematicObject();
  const bool needs_field = needs_distance_field(*collider.shape, collider.facets);
  const ExactCollider exact(collider, margin);
  const auto look_at = [&](int i, std::vector<RigidContact>& found) {
    const btSoftBody::Node& node = body.m_nodes[i];
    if ((node.m_im <= 0 && !looks_at_pinned) || node.m_battach != 0) return;
    btVector3 motion(0, 0, 0);
    if (led != nullptr) {
      motion = time_step * led->getVelocityInLocalPoint(node.m_x - led->getCenterOfMassPosition());
    }
    const btVector3 from = node.m_q + motion;
    const btVector3 to = dynamic != nullptr ? back * node.m_x : node.m_x;
    btVector3 least = from;
    btVector3 most = from;
    least.setMin(to);
    most.setMax(to);
    if (!meet(box_of(least, most), box)) return;
    const bool is_fast = (to - from).length2() > margin * margin;
    auto contact = needs_field ? find_in_field(body, collider, from, to, margin, is_fast)
                               : exact.find(from, to, is_fast);
    if (!contact) return;
    contact->node = i;
    contact->motion = motion;
    contact->object = collider.object;
    contact->collider = collider.number;
    if (dynamic != nullptr) {
      contact->met = to;
      contact->met_by_object = collider.object_place.invXform(to);
      contact->normal_by_object = contact->normal * collider.object_place.getBasis();
      contact->gap = btDot(contact->normal, to) - contact->offset;
      follow_object(*contact, collider.motion * collider.object_place);
    }
    found.push_back(*contact);
  };
  const auto look_at_groups = [&](std::size_t begin, std::size_t end,
                                  std::vector<RigidContact>& found) {
    for (std::size_t g = begin; g < end; ++g) {
      if (!meet(ways.boxes()[g], reached)) continue;
      for (const int i : ways.group(g)) look_at(i, found);
    }
  };
  // Bullet's field is made as it is asked.
  ways.collect(look_at_groups, needs_field ? nullptr : team, contacts);
}

void follow_object(RigidContact& contact, const btTransform& object_place) {
  if (movable(contact.object) == nullptr) return;
  const btVector3 now = object_place * contact.met_by_object;
  contact.motion = now - contact.met;
  contact.normal = object_place.getBasis() * contact.normal_by_object;
  contact.offset = btDot(contact.normal, now) - contact.gap;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
