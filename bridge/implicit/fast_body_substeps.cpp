// Substeps: a step is divided if a dynamic body moves so far in it that its surface turns away from the nodes that it met.
// Tested by tests/bridge/implicit/fast_body_impact_test.cpp.
#include <algorithm>
#include <cmath>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/implicit/fast_body.hpp>
#include <weft/bridge/implicit/node_anchors.hpp>
#include <weft/bridge/rigid/rigid_substeps.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// How far a shape may approach a node in one substep, as a share of its smallest half extent [-].
constexpr btScalar kApproachShare = btScalar(0.2);
/// Likewise: how far springs may push it back in one substep.
constexpr btScalar kPushShare = btScalar(0.05);
constexpr int kMostSubsteps = 32;

btScalar smallest_half_extent(const btCollisionShape& shape) {
  btVector3 low;
  btVector3 high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const btVector3 size = (high - low) / 2;
  return std::min({size.x(), size.y(), size.z()});
}

}  // namespace

int FastBody::num_substeps(const btSoftBody& body, btScalar time_step) const {
  btScalar most = 1;
  bool touches_dynamic = false;
  for (const RigidContact& contact : contacts_) {
    const MovableObject object{contact.object};
    if (!object || object.is_articulated()) continue;
    touches_dynamic = true;
    const Collider& collider = colliders_[static_cast<std::size_t>(contact.collider)];
    const btVector3 normal = collider.object_pose.getBasis() * contact.normal_by_object;
    const btScalar approach = btDot(normal, body.m_nodes[contact.node].m_q - contact.met);
    // By what cloth has done to it in the last solve: so it will go on.
    const btScalar weight = 2 * time_step * time_step * object.gravity().length();
    const btScalar pushed = pushed_.push_in(object, time_step) - weight;
    const btScalar size =
        std::max(smallest_half_extent(*collider.shape), body.getCollisionShape()->getMargin());
    most = std::max({most, approach / (kApproachShare * size), pushed / (kPushShare * size)});
  }
  // Not much fewer than before: what short steps have begun goes on.
  if (touches_dynamic) most = std::max(most, static_cast<btScalar>(last_num_substeps_) / 2);
  return std::min(kMostSubsteps, static_cast<int>(std::ceil(most)));
}

void FastBody::list_dynamic(const btSoftBody& body, std::vector<MovableObject>& list) const {
  const auto add = [&](const btCollisionObject* one) {
    const MovableObject object{one};
    if (object && std::find(list.begin(), list.end(), object) == list.end()) {
      list.push_back(object);
    }
  };
  for (const Collider& collider : colliders_) add(collider.object);
  for_anchors(body, [&](const NodeAnchor& anchor) { add(anchor.object); });
}

void FastBody::begin_substeps(const btSoftBody& body, btScalar time_step) {
  whole_starts_ = starts_;
  accelerations_ = (predicted_ - start_velocities_) / time_step;
  pin_ends_.clear();
  for (const int pin : pins_) pin_ends_.push_back(body.m_nodes[pin].m_x);
}

void FastBody::begin_substep(btSoftBody& body, const RigidSubsteps& rigid, int substep,
                             int num_substeps, btScalar substep_time) {
  if (substep > 0) {
    last_starts_ = starts_;
    last_spacing_ = substep_time;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      starts_.col(i) = from_bullet<btScalar>(body.m_nodes[i].m_x) - origin_;
    }
    start_velocities_ = velocities_;
    impulses_.resize(3, 0);
  }
  last_step_ = 0;  // BDF2 knows no substeps
  num_substeps_ = num_substeps;
  const btScalar reached = static_cast<btScalar>(substep + 1) / static_cast<btScalar>(num_substeps);
  predicted_ = start_velocities_ + substep_time * accelerations_;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    node.m_q = to_bullet((starts_.col(i) + origin_).eval());
    if (node.m_im > 0)
      node.m_x = to_bullet((starts_.col(i) + substep_time * predicted_.col(i) + origin_).eval());
  }
  for (std::size_t k = 0; k < pins_.size(); ++k) {
    const btVector3 start = to_bullet((whole_starts_.col(pins_[k]) + origin_).eval());
    body.m_nodes[pins_[k]].m_x =
        substep + 1 == num_substeps ? pin_ends_[k] : start.lerp(pin_ends_[k], reached);
  }
  contacts_.clear();
  pushed_.begin_step();
  is_support_missing_ = false;
  swept_.invalidate();
  for (Collider& collider : colliders_) {
    const MovableObject dynamic{collider.object};
    if (!dynamic) continue;
    const btTransform start = rigid.start_of(dynamic);
    collider.pose = start * collider.object_pose.inverse() * collider.pose;
    collider.object_pose = start;
  }
}

void FastBody::end_substeps(btSoftBody& body, btScalar time_step) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    node.m_q = to_bullet((whole_starts_.col(i) + origin_).eval());
    if (node.m_im <= 0) node.m_v = (node.m_x - node.m_q) / time_step;
  }
  starts_ = whole_starts_;
  velocity_step_ = time_step;  // rates of damping count for the whole step
  last_step_ = 0;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
