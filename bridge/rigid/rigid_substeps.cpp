#include <weft/bridge/rigid/rigid_substeps.hpp>

#include <algorithm>

#include <LinearMath/btTransformUtil.h>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

btTransform moved(const btTransform& start, const MovableObject& body, btScalar time) {
  const RigidVelocity velocity = body.velocity();
  btTransform result;
  btTransformUtil::integrateTransform(start, velocity.linear, velocity.angular, time, result);
  return result;
}

}  // namespace

RigidSubsteps::RigidSubsteps(const std::vector<MovableObject>& bodies, btScalar time_step,
                             int num_substeps)
    : substep_time_(time_step / static_cast<btScalar>(num_substeps)) {
  for (const MovableObject& body : bodies) {
    const btTransform& now = body.pose();
    entries_.push_back({body, now, moved(now, body, -time_step), now});
  }
}

void RigidSubsteps::begin_substep() {
  for (Entry& one : entries_) {
    one.alone = moved(one.start, one.body, substep_time_);
    one.body.set_pose(one.alone);
  }
}

void RigidSubsteps::end_substep() {
  for (Entry& one : entries_) {
    const btTransform going_on = moved(one.start, one.body, substep_time_);
    const bool is_moved = !(one.body.pose() == one.alone);
    one.is_held = one.is_held || (!is_moved && !(going_on == one.alone));
    one.start = is_moved ? one.body.pose() : going_on;
  }
}

void RigidSubsteps::finish() {
  for (const Entry& one : entries_) {
    const bool stays = one.is_held || one.body.is_articulated();
    one.body.set_pose(stays ? one.moved : one.start);
  }
}

const btTransform& RigidSubsteps::start_of(const MovableObject& body) const {
  return std::find_if(entries_.begin(), entries_.end(),
                      [&](const Entry& one) { return one.body == body; })
      ->start;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
