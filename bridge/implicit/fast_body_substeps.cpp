// Divides a step into substeps; substep_count.hpp says why.
// Tested by tests/bridge/implicit/fast_body_impact_test.cpp.
#include <algorithm>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/implicit/fast_body.hpp>
#include <weft/bridge/implicit/node_anchors.hpp>
#include <weft/bridge/implicit/substeps/pin_pull.hpp>
#include <weft/bridge/implicit/substeps/relative_motion.hpp>
#include <weft/bridge/rigid/rigid_substeps.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

btScalar smallest_half_extent(const btCollisionShape& shape) {
  btVector3 low;
  btVector3 high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const btVector3 size = (high - low) / 2;
  return std::min({size.x(), size.y(), size.z()});
}

}  // namespace

int FastBody::num_substeps(const btSoftBody& body, btScalar time_step) const {
  SubstepCount substeps(time_step * wave_speed_, static_cast<btScalar>(masses_.sum()));
  for (const Collider& collider : colliders_) {
    const MovableObject object{collider.object};
    if (moves_freely(object)) substeps.include_nearby_body();
  }
  const RelativeMotion motion(contacts_, start_velocities_);
  const PinPull pull(pins_, positions_, starts_, contacts_);
  for (const RigidContact& contact : contacts_) {
    const MovableObject object{contact.object};
    if (!moves_freely(object)) continue;
    const Collider& collider = colliders_[static_cast<std::size_t>(contact.collider)];
    const btVector3 normal = collider.object_pose.getBasis() * contact.normal_by_object;
    substeps.include(
        {.size =
             std::max(smallest_half_extent(*collider.shape), body.getCollisionShape()->getMargin()),
         .approach = btDot(normal, body.m_nodes[contact.node].m_q - contact.met),
         .closing = time_step * btDot(normal, motion.at(contact)),
         .pushed = pushed_.push_in(object, time_step),
         .fall = time_step * time_step * object.gravity().length(),
         .inverse_mass = object.inverse_mass(),
         .pulled = pull.on(contact.node, time_step * start_velocities_.col(contact.node))});
  }
  return substeps.count(last_num_substeps_);
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

// A program moves pinned nodes before a step. They go there during the step: all in the first substep would be a blow.
void FastBody::move_pins_evenly() {
  if (pins_.empty() || positions_.cols() != starts_.cols()) return;
  const Matrix3X<btScalar> last = positions_(Eigen::all, pins_);
  if (are_positions_kept()) starts_(Eigen::all, pins_) = last;
}

void FastBody::begin_substeps(const btSoftBody& body, btScalar time_step) {
  whole_starts_ = starts_;
  move_pins_evenly();
  accelerations_ = (predicted_ - start_velocities_) / time_step;
  pin_starts_ = starts_(Eigen::all, pins_).colwise() + origin_;
  pin_ends_.clear();
  for (const int pin : pins_) pin_ends_.push_back(body.m_nodes[pin].m_x);
}

void FastBody::begin_substep(btSoftBody& body, const RigidSubsteps& rigid, int substep,
                             const SubstepPlan& plan, btScalar substep_time) {
  const int num_substeps = plan.count;
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
  num_substeps_ = plan.num_implicit;
  is_explicit_ = plan.is_explicit;
  if (is_explicit_ && substep == 0) explicit_.begin(*solver_, masses_, is_free_, solver_pins_);
  time_left_ = substep_time * static_cast<btScalar>(num_substeps - substep - 1);
  const btScalar reached = static_cast<btScalar>(substep + 1) / static_cast<btScalar>(num_substeps);
  predicted_ = start_velocities_ + substep_time * accelerations_;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    node.m_q = to_bullet((starts_.col(i) + origin_).eval());
    if (node.m_im > 0)
      node.m_x = to_bullet((starts_.col(i) + substep_time * predicted_.col(i) + origin_).eval());
  }
  for (std::size_t k = 0; k < pins_.size(); ++k) {
    const btVector3 start = to_bullet(pin_starts_.col(static_cast<Eigen::Index>(k)).eval());
    body.m_nodes[pins_[k]].m_x =
        substep + 1 == num_substeps ? pin_ends_[k] : start.lerp(pin_ends_[k], reached);
  }
  contacts_.clear();
  pushed_.begin_step();
  is_support_missing_ = false;
  swept_.invalidate();
  for (Collider& collider : colliders_) {
    const MovableObject dynamic{collider.object};
    if (!dynamic) {
      if (collider.led.is_zero() || btRigidBody::upcast(collider.object) == nullptr) continue;
      const btTransform pose = kinematic_pose(*collider.object, time_left_);
      collider.pose = pose * collider.object_pose.inverse() * collider.pose;
      collider.object_pose = pose;
      continue;
    }
    const btTransform& start = rigid.start_of(dynamic);
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
  if (is_explicit_) solver_->continue_contacts(explicit_.solver());
  is_explicit_ = false;
  time_left_ = 0;
  velocity_step_ = time_step;  // rates of damping count for the whole step
  last_step_ = 0;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
