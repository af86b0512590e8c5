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
#include <weft/bridge/contact/surface/concave_surface.hpp>
#include <weft/bridge/contact/surface/solid_distances.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

MotionBox box_of(const btVector3& low, const btVector3& high) {
  return {{low.x(), low.y(), low.z(), 0}, {high.x(), high.y(), high.z(), 0}};
}

/// The swept bounds of some nodes, at least one.
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

/// Plane through the first surface on the segment from one point to another, by Bullet's test of rays, which is true to about a
/// millimetre.
std::optional<RigidContact> first_hit(const Collider& collider, const btVector3& from,
                                      const btVector3& to, btScalar margin) {
  btCollisionWorld::ClosestRayResultCallback hit(from, to);
  // Bullet's default test of a ray with a convex shape passes through a box of 2 cm in one of six
  // cases that start within 6 cm of it; this one in none.
  hit.m_flags |= btTriangleRaycastCallback::kF_UseGjkConvexCastRaytest;
  btCollisionWorld::rayTestSingle(
      btTransform(btQuaternion::getIdentity(), from), btTransform(btQuaternion::getIdentity(), to),
      const_cast<btCollisionObject*>(collider.object), collider.shape, collider.pose, hit);
  if (!hit.hasHit() || !(hit.m_hitNormalWorld.length2() > 0)) return std::nullopt;
  RigidContact contact;
  contact.normal = hit.m_hitNormalWorld.normalized();
  if (btDot(contact.normal, to - from) > 0) contact.normal = -contact.normal;
  contact.offset = btDot(contact.normal, from.lerp(to, hit.m_closestHitFraction)) + margin;
  return contact;
}

/// A collider that surface_distance() knows, in double precision: the ground may be a box of many meters, whose
/// positions are rounded to a millionth of it in single precision.
class ExactCollider {
 public:
  ExactCollider(const Collider& collider, btScalar margin)
      : collider_(collider),
        margin_(static_cast<double>(margin)),
        origin_(from_bullet(collider.pose.getOrigin())) {
    for (int k = 0; k < 3; ++k) turn_.row(k) = from_bullet(collider.pose.getBasis().getRow(k));
  }

  /// The contact of a node that moves from one point to another. One that is followed, or would end inside, is stopped where
  /// its path first meets the surface, or, if it begins inside, at the face that is nearest there: where it would end another
  /// face may be nearer.
  [[nodiscard]] std::optional<RigidContact> find(const btVector3& from, const btVector3& to,
                                                 bool is_followed) const {
    const Vector3<double> start = local(from);
    const Vector3<double> end = local(to);
    const double reach = 2 * margin_;
    const double length = (end - start).norm() * (1 + kRounding);
    const SurfaceDistance at_end = distance_at(end, is_followed ? std::max(reach, length) : reach);
    if (at_end.distance < (is_followed ? length : 0)) {
      if (auto contact = first_on_path(start, end, length)) return contact;
    }
    if (at_end.distance >= reach) return std::nullopt;
    if (at_end.distance < 0) {
      const SurfaceDistance at_start = distance_at(start, reach);
      if (at_start.distance <= 0) return plane_at(start, at_start);
    }
    return plane_at(end, at_end);
  }

  /// The plane that holds a node in front of the surface which is at this distance.
  [[nodiscard]] RigidContact plane_at(const Vector3<double>& point,
                                      const SurfaceDistance& surface) const {
    RigidContact contact;
    contact.normal = to_bullet((turn_ * surface.out).eval());
    // With the normal as it is rounded, so that the plane is where it should be for this position.
    contact.offset = static_cast<btScalar>(
        from_bullet(contact.normal).dot(turn_ * point + origin_) - surface.distance + margin_);
    return contact;
  }

 private:
  static constexpr double kRounding = 1e-6;  ///< of paths in single precision
  static constexpr double kTouch =
      1e-3;                              ///< a node this near touches, as a share of the margin [-]
  static constexpr int kMostSteps = 32;  ///< of Newton's method; three to five are usual

  // The distance from a convex solid is a convex function along a straight path: Newton's method comes to the first meeting
  // from before it and never passes it. A path that begins inside has none.
  [[nodiscard]] std::optional<RigidContact> first_on_path(const Vector3<double>& start,
                                                          const Vector3<double>& end,
                                                          double length) const {
    const Vector3<double> path = end - start;
    double share = 0;
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector3<double> point = start + share * path;
      const SurfaceDistance here = distance_at(point, length);
      if (here.distance >= length || (step == 0 && here.distance <= 0)) return std::nullopt;
      if (here.distance <= kTouch * margin_) return plane_at(point, here);
      const double slope = here.out.dot(path);
      if (!(slope < 0)) return std::nullopt;
      share -= here.distance / slope;
      if (!(share <= 1)) return std::nullopt;
    }
    return plane_at(start + share * path, distance_at(start + share * path, length));
  }

  [[nodiscard]] Vector3<double> local(const btVector3& point) const {
    return turn_.transpose() * (from_bullet(point) - origin_);
  }
  [[nodiscard]] SurfaceDistance distance_at(const Vector3<double>& point, double reach) const {
    return surface_distance(*collider_.shape, collider_.facets, point, reach).value();
  }

  const Collider& collider_;
  double margin_;
  Vector3<double> origin_;
  Matrix3<double> turn_;
};

/// A collider of the kind that ConcaveSurface knows.
class ConcaveCollider {
 public:
  ConcaveCollider(const Collider& collider, btScalar margin)
      : surface_(*collider.shape),
        pose_(collider.pose),
        margin_(static_cast<double>(margin)),
        origin_(from_bullet(collider.pose.getOrigin())) {
    for (int k = 0; k < 3; ++k) turn_.row(k) = from_bullet(collider.pose.getBasis().getRow(k));
  }

  /// Triangles that nodes may meet whose paths, as the collider sees them, are in a box.
  void gather(const MotionBox& box, std::vector<ConcaveSurface::Triangle>& triangles) const {
    const btVector3 low(box.low[0], box.low[1], box.low[2]);
    const btVector3 high(box.high[0], box.high[1], box.high[2]);
    const btTransform back = pose_.inverse();
    btVector3 local_low;
    btVector3 local_high;
    btTransformAabb(low, high, 0, back, local_low, local_high);
    surface_.gather(local_low, local_high, triangles);
  }

  /// The contacts of a node that moves from one point to another, among those triangles.
  void find(const btVector3& from, const btVector3& to,
            std::span<const ConcaveSurface::Triangle> triangles,
            std::vector<ConcaveSurface::Plane>& planes, std::vector<RigidContact>& found) const {
    planes.clear();
    const Vector3<double> end = local(to);
    surface_.add_planes(local(from), end, triangles, 2 * margin_, planes);
    for (const ConcaveSurface::Plane& plane : planes) {
      RigidContact contact;
      contact.normal = to_bullet((turn_ * plane.normal).eval());
      const double distance = plane.normal.dot(end) - plane.offset;
      contact.offset = static_cast<btScalar>(from_bullet(contact.normal).dot(from_bullet(to)) -
                                             distance + margin_);
      contact.triangle = plane.id;
      found.push_back(contact);
    }
  }

 private:
  [[nodiscard]] Vector3<double> local(const btVector3& point) const {
    return turn_.transpose() * (from_bullet(point) - origin_);
  }

  ConcaveSurface surface_;
  btTransform pose_;
  double margin_;
  Vector3<double> origin_;
  Matrix3<double> turn_;
};

/// The same in Bullet's distance field of any shape.
std::optional<RigidContact> find_in_field(const btSoftBody& body, const Collider& collider,
                                          const btVector3& from, const btVector3& to,
                                          btScalar margin, bool is_followed) {
  if (is_followed) {
    if (auto contact = first_hit(collider, from, to, margin)) return contact;
  }
  const btCollisionObjectWrapper object(nullptr, collider.shape, collider.object, collider.pose, -1,
                                        -1);
  btSoftBody::sCti found;
  if (!body.checkContact(&object, to, 2 * margin, found)) return std::nullopt;
  RigidContact contact;
  contact.normal = found.m_normal;
  contact.offset = -found.m_offset - margin;  // Bullet's plane is where it looked, at 2 margins
  return contact;
}

/// The contacts of a body's nodes with a collider, by the kind of its shape.
class ContactFinder {
 public:
  /// The surroundings of the nodes of a group, and memory to work with.
  struct Nearby {
    std::vector<ConcaveSurface::Triangle> triangles;
    std::vector<ConcaveSurface::Plane> planes;
  };

  ContactFinder(const btSoftBody& body, const Collider& collider, btScalar margin)
      : body_(body), collider_(collider), margin_(margin) {
    if (ConcaveSurface::has(*collider.shape)) {
      concave_.emplace(collider, margin);
    } else if (!needs_distance_field(*collider.shape, collider.facets)) {
      exact_.emplace(collider, margin);
    }
  }

  /// Before the nodes of a group whose paths, as the collider sees them, are in a box.
  void gather(const MotionBox& box, Nearby& nearby) const {
    nearby.triangles.clear();
    if (!concave_) return;
    concave_->gather(box.grown(2 * margin_ + collider_.shape->getMargin()), nearby.triangles);
  }

  /// For a group of nodes at a time, of an object that stands still; none for most shapes.
  [[nodiscard]] std::optional<SolidDistances> solid_distances() const {
    if (!SolidDistances::has(*collider_.shape)) return std::nullopt;
    return SolidDistances(collider_);
  }
  /// For shapes that have solid_distances().
  [[nodiscard]] RigidContact contact_at(const SolidDistances::Distances& found, int lane) const {
    return exact_->plane_at(found.point(lane), found.surface(lane));
  }
  [[nodiscard]] bool is_followed(const btVector3& from, const btVector3& to) const {
    return (to - from).length2() > margin_ * margin_;
  }
  [[nodiscard]] double reach() const { return 2 * static_cast<double>(margin_); }

  /// Appends those of a node that moves from one point to another, where they are.
  void find(const btVector3& from, const btVector3& to, Nearby& nearby,
            std::vector<RigidContact>& found) const {
    if (concave_) return concave_->find(from, to, nearby.triangles, nearby.planes, found);
    const bool follows = is_followed(from, to);
    const auto contact = exact_ ? exact_->find(from, to, follows)
                                : find_in_field(body_, collider_, from, to, margin_, follows);
    if (contact) found.push_back(*contact);
  }

 private:
  const btSoftBody& body_;
  const Collider& collider_;
  btScalar margin_;
  std::optional<ConcaveCollider> concave_;
  std::optional<ExactCollider> exact_;
};

/// Nodes of a group, in the order of the group, and where they end.
struct NodeBatch {
  SolidDistances::Vectors ends;
  std::array<int, SolidDistances::kLanes> nodes;
  int count = 0;

  NodeBatch() {
    for (SolidDistances::Lanes& coordinates : ends) coordinates.setZero();
  }
  void add(int node, const btVector3& end) {
    for (std::size_t k = 0; k < 3; ++k) {
      ends[k][count] = static_cast<double>(end[static_cast<int>(k)]);
    }
    nodes[static_cast<std::size_t>(count++)] = node;
  }
};

/// Those nodes of a group whose paths meet a box.
template <class IsLookedAt>
NodeBatch batch_of(const btSoftBody& body, std::span<const int> group, const MotionBox& box,
                   const IsLookedAt& is_looked_at) {
  NodeBatch batch;
  for (const int i : group) {
    if (!is_looked_at(i)) continue;
    const btSoftBody::Node& node = body.m_nodes[i];
    const Four low = four(node.m_q).min(four(node.m_x));
    const Four high = four(node.m_q).max(four(node.m_x));
    const bool is_apart = low[0] > box.high[0] || low[1] > box.high[1] || low[2] > box.high[2] ||
                          box.low[0] > high[0] || box.low[1] > high[1] || box.low[2] > high[2];
    if (!is_apart) batch.add(i, node.m_x);
  }
  return batch;
}

/// Appends the contacts of some nodes with an object that stands still.
void find_together(const btSoftBody& body, const ContactFinder& finder, const SolidDistances& solid,
                   const NodeBatch& batch, const Collider& collider,
                   std::vector<RigidContact>& found) {
  if (batch.count == 0) return;
  const SolidDistances::Distances distances = solid.of(batch.ends);
  ContactFinder::Nearby nearby;
  for (int lane = 0; lane < batch.count; ++lane) {
    const int i = batch.nodes[static_cast<std::size_t>(lane)];
    const btSoftBody::Node& node = body.m_nodes[i];
    const std::size_t num_before = found.size();
    if (finder.is_followed(node.m_q, node.m_x) || distances.distance[lane] < 0) {
      finder.find(node.m_q, node.m_x, nearby, found);
    } else if (!(distances.distance[lane] >= finder.reach())) {
      found.push_back(finder.contact_at(distances, lane));
    }
    if (found.size() == num_before) continue;
    found.back().node = i;
    found.back().object = collider.object;
    found.back().collider = collider.number;
  }
}

/// [m] No node among those of a box moves farther with the body in a step.
btScalar largest_motion(const RigidVelocity& velocity, const MotionBox& nodes, btScalar time_step) {
  btScalar reach2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const btScalar center = velocity.center[static_cast<int>(k)];
    const btScalar reach =
        std::max(std::abs(nodes.low[k] - center), std::abs(nodes.high[k] - center));
    reach2 += reach * reach;
  }
  return time_step * (velocity.linear.length() + velocity.angular.length() * std::sqrt(reach2));
}

/// The same with a motion that is known: the corner that goes farthest.
btScalar largest_motion(const btTransform& back, const MotionBox& nodes) {
  btScalar most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [&](int axis) {
      const auto k = static_cast<std::size_t>(axis);
      return (corner >> axis & 1) != 0 ? nodes.high[k] : nodes.low[k];
    };
    const btVector3 point(side(0), side(1), side(2));
    most = std::max(most, (back * point - point).length());
  }
  return most;
}

}  // namespace

Collider make_collider(const btCollisionObjectWrapper& object, const HullFacets* facets, int number,
                       btScalar time_step) {
  Collider collider{object.getCollisionObject(), object.getCollisionShape(),
                    object.getWorldTransform(), facets, number};
  if (const MovableObject movable{collider.object}) {
    const RigidVelocity velocity = movable.velocity();
    btTransform end;
    btTransformUtil::integrateTransform(movable.pose(), velocity.linear, velocity.angular,
                                        time_step, end);
    collider.object_pose = movable.pose();
    collider.motion = end * collider.object_pose.inverse();
  } else {
    collider.object_pose = collider.object->getWorldTransform();
    collider.led = velocity_of(*collider.object);
  }
  return collider;
}

const btCollisionShape* concave_shape_of(const btCollisionObjectWrapper& object) {
  const btCollisionShape* const shape = object.getCollisionObject()->getCollisionShape();
  return shape != nullptr && ConcaveSurface::has(*shape) ? shape : nullptr;
}

bool is_detected_alone(const Collider& collider) {
  if (ConcaveSurface::has(*collider.shape)) return ConcaveSurface(*collider.shape).is_thread_safe();
  return !needs_distance_field(*collider.shape, collider.facets);
}

bool is_still_solid(const Collider& collider) {
  return !ConcaveSurface::has(*collider.shape) && is_detected_alone(collider) &&
         collider.led.is_zero() && link_of(collider.object) == nullptr &&
         !MovableObject(collider.object);
}

void SweptNodes::update(const btSoftBody& body, fast::WorkerTeam* team) {
  if (is_current_) return;
  is_current_ = true;
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
  if (const std::size_t num_ranges = num_ranges_for(team); num_ranges > 1) {
    team->run(static_cast<int>(num_ranges), [&](int range) {
      const auto p = static_cast<std::size_t>(range);
      enclose(boxes_.size() * p / num_ranges, boxes_.size() * (p + 1) / num_ranges);
    });
  } else {
    enclose(0, boxes_.size());
  }
  all_ = MotionBox::nowhere();
  for (const MotionBox& box : boxes_) all_.include(box);
}

void add_rigid_contacts(const btSoftBody& body, SweptNodes& swept, const Collider& collider,
                        btScalar time_step, PinnedNodes pinned, std::vector<RigidContact>& contacts,
                        fast::WorkerTeam* team, std::span<const char> is_left_out) {
  if (!collider.object->hasContactResponse()) return;
  // Bullet has the pose of a dynamic body at the start of the step, and that of a kinematic one at its end.
  const MovableObject dynamic{collider.object};
  const RigidVelocity& velocity = collider.led;
  const bool is_kinematic = !velocity.is_zero();
  const btTransform back = collider.motion.inverse();
  const btScalar margin = body.getCollisionShape()->getMargin();
  btVector3 low;
  btVector3 high;
  collider.shape->getAabb(collider.pose, low, high);
  // Bounds of a mesh of triangles are without its margin.
  const btScalar own = ConcaveSurface::has(*collider.shape) ? collider.shape->getMargin() : 0;
  const MotionBox box = box_of(low, high).grown(2 * margin + own);
  btScalar farthest = 0;  // that an object moves with respect to a node [m]
  if (dynamic) farthest = largest_motion(back, swept.all());
  if (is_kinematic) farthest = largest_motion(velocity, swept.all(), time_step);
  const MotionBox reached = box.grown(farthest);
  if (!meet(reached, swept.all())) return;
  const bool looks_at_pinned =
      pinned == PinnedNodes::kWithDynamicObjects && !collider.object->isStaticOrKinematicObject();
  const ContactFinder finder(body, collider, margin);
  const auto is_looked_at = [&](int i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    return (node.m_im > 0 || looks_at_pinned) && node.m_battach == 0 &&
           (is_left_out.empty() || is_left_out[static_cast<std::size_t>(i)] == 0);
  };
  const auto look_at = [&](int i, ContactFinder::Nearby& nearby, std::vector<RigidContact>& found) {
    const btSoftBody::Node& node = body.m_nodes[i];
    btVector3 motion(0, 0, 0);
    if (is_kinematic) motion = time_step * velocity.at(node.m_x);
    const btVector3 from = node.m_q + motion;
    const btVector3 to = dynamic ? back * node.m_x : node.m_x;
    btVector3 least = from;
    btVector3 most = from;
    least.setMin(to);
    most.setMax(to);
    if (!meet(box_of(least, most), box)) return;
    const std::size_t num_before = found.size();
    finder.find(from, to, nearby, found);
    for (std::size_t c = num_before; c < found.size(); ++c) {
      RigidContact& contact = found[c];
      contact.node = i;
      contact.motion = motion;
      contact.object = collider.object;
      contact.collider = collider.number;
      if (!dynamic) continue;
      contact.is_dynamic = true;
      contact.met = to;
      contact.met_by_object = collider.object_pose.invXform(to);
      contact.normal_by_object = contact.normal * collider.object_pose.getBasis();
      contact.gap = btDot(contact.normal, to) - contact.offset;
      follow_object(contact, collider.motion * collider.object_pose);
    }
  };
  const std::optional<SolidDistances> solid =
      dynamic || is_kinematic ? std::nullopt : finder.solid_distances();
  const auto look_at_groups = [&](std::size_t begin, std::size_t end,
                                  std::vector<RigidContact>& found) {
    ContactFinder::Nearby nearby;
    for (std::size_t g = begin; g < end; ++g) {
      if (!meet(swept.boxes()[g], reached)) continue;
      if (solid) {
        find_together(body, finder, *solid, batch_of(body, swept.group(g), box, is_looked_at),
                      collider, found);
        continue;
      }
      finder.gather(swept.boxes()[g].grown(farthest), nearby);
      for (const int i : swept.group(g)) {
        if (is_looked_at(i)) look_at(i, nearby, found);
      }
    }
  };
  // Bullet's field is made as it is asked.
  swept.collect(look_at_groups, is_detected_alone(collider) ? team : nullptr, contacts);
}

void follow_object(RigidContact& contact, const btTransform& object_pose) {
  if (!MovableObject(contact.object)) return;
  const btVector3 now = object_pose * contact.met_by_object;
  contact.motion = now - contact.met;
  contact.normal = object_pose.getBasis() * contact.normal_by_object;
  contact.offset = btDot(contact.normal, now) - contact.gap;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
