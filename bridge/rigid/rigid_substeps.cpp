#include <weft/bridge/rigid/rigid_substeps.hpp>

#include <algorithm>
#include <limits>

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
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

/// Whether poses differ by more than rounding: in a short substep an impulse may move a body by less than that.
bool differ(const btTransform& a, const btTransform& b) {
  constexpr btScalar kRounding = 8 * std::numeric_limits<btScalar>::epsilon();
  const auto is_far = [](const btVector3& one, const btVector3& other) {
    const btVector3 sizes = one.absolute() + other.absolute();
    const btScalar size = std::max(btScalar(1), sizes[sizes.maxAxis()]);
    const btVector3 difference = (one - other).absolute();
    return !(difference[difference.maxAxis()] <= kRounding * size);
  };
  return is_far(a.getOrigin(), b.getOrigin()) || is_far(a.getBasis()[0], b.getBasis()[0]) ||
         is_far(a.getBasis()[1], b.getBasis()[1]) || is_far(a.getBasis()[2], b.getBasis()[2]);
}

void accelerate(const MovableObject& body, const btVector3& by) {
  body.rigid()->setLinearVelocity(body.rigid()->getLinearVelocity() + by);
}

/// Whether Bullet has given a body all that gravity does in the step: no joint and no contact has taken any of it.
bool falls_freely(const MovableObject& body, btDispatcher* dispatcher) {
  if (body.rigid() == nullptr || !body.object()->isActive() || is_jointed(body.object()))
    return false;
  const int num_manifolds = dispatcher != nullptr ? dispatcher->getNumManifolds() : 0;
  for (int m = 0; m < num_manifolds; ++m) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(m);
    if (manifold.getBody0() != body.object() && manifold.getBody1() != body.object()) continue;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      if (manifold.getContactPoint(p).getAppliedImpulse() != 0) return false;
    }
  }
  return true;
}

}  // namespace

RigidSubsteps::RigidSubsteps(const std::vector<MovableObject>& bodies, btScalar time_step,
                             int num_substeps)
    : num_left_(num_substeps), substep_time_(time_step / static_cast<btScalar>(num_substeps)) {
  for (const MovableObject& body : bodies) {
    const btTransform& now = body.pose();
    entries_.push_back({body, now, moved(now, body, -time_step), now});
  }
}

void RigidSubsteps::share_out_gravity(std::size_t number, btDispatcher* dispatcher) {
  Entry& entry = entries_[number];
  const MovableObject& body = entry.body;
  if (!falls_freely(body, dispatcher)) return;
  entry.fall = substep_time_ * body.gravity() * body.rigid()->getLinearFactor();
  accelerate(body, -static_cast<btScalar>(num_left_) * entry.fall);
}

void RigidSubsteps::begin_substep() {
  for (Entry& one : entries_) {
    if (!one.fall.isZero()) accelerate(one.body, one.fall);
    one.alone = moved(one.start, one.body, substep_time_);
    one.body.set_pose(one.alone);
  }
}

void RigidSubsteps::end_substep() {
  for (Entry& one : entries_) {
    const btTransform going_on = moved(one.start, one.body, substep_time_);
    const bool is_moved = !(one.body.pose() == one.alone);
    one.is_held = !is_moved && differ(going_on, one.alone);
    one.start = is_moved ? one.body.pose() : going_on;
  }
  --num_left_;
}

void RigidSubsteps::finish() {
  while (num_left_ > 0) {
    begin_substep();
    end_substep();
  }
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
