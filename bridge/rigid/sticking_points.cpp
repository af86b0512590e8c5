#include <weft/bridge/rigid/sticking_points.hpp>

#include <algorithm>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

const btVector3* StickingPoints::find(int node, const MovableObject& object) const {
  const auto found = std::find_if(points_.begin(), points_.end(), [&](const Point& one) {
    return one.node == node && one.link == object.object();
  });
  return found != points_.end() ? &found->local : nullptr;
}

void StickingPoints::add(int node, const MovableObject& object, bool sticks,
                         const btTransform& solved_pose, const btVector3& position) {
  if (object.link() == nullptr || object.is_placeable()) return;
  const btVector3* const known = sticks ? find(node, object) : nullptr;
  next_.push_back(
      {node, object.object(), known != nullptr ? *known : solved_pose.invXform(position)});
}

void LedLinks::begin_step(btScalar time_step) {
  time_step_ = time_step;
  std::erase_if(links_, [](const Link& one) { return !one.is_of_this_step; });
  for (Link& one : links_) one.is_of_this_step = false;
}

void LedLinks::follow(Collider& collider) {
  const btTransform end = collider.object->getWorldTransform();
  auto link = std::find_if(links_.begin(), links_.end(),
                           [&](const Link& one) { return one.object == collider.object; });
  if (link == links_.end() || !link->is_of_this_step) {
    const btTransform start = link != links_.end() ? link->end : collider.object_pose;
    if (link == links_.end()) link = links_.insert(links_.end(), {collider.object, end, {}, true});
    const RigidVelocity by_pose = mean_velocity(start, end, time_step_);
    *link = {collider.object, end, by_pose.is_zero() ? collider.led : by_pose, true};
  }
  collider.led = link->velocity;
  if (collider.object_pose == end) return;  // no rounding for what stands where it is
  collider.pose = end * collider.object_pose.inverse() * collider.pose;
  collider.object_pose = end;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
