#include <weft/bridge/rigid/movable_object.hpp>

#include <algorithm>
#include <cmath>

#include <LinearMath/btTransformUtil.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/rigid/multibody_inertia.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
btMultiBodyLinkCollider* link_of(const btCollisionObject* object) {
  if (object == nullptr) return nullptr;
  auto* link = btMultiBodyLinkCollider::upcast(const_cast<btCollisionObject*>(object));
  return link != nullptr && link->m_multiBody != nullptr ? link : nullptr;
}

btTransform kinematic_pose(const btCollisionObject& object, btScalar time_left) {
  const btTransform& end = object.getWorldTransform();
  if (time_left == 0 || btRigidBody::upcast(&object) == nullptr) return end;
  const RigidVelocity velocity = velocity_of(object);
  if (velocity.is_zero()) return end;
  btTransform pose;
  btTransformUtil::integrateTransform(end, -velocity.linear, -velocity.angular, time_left, pose);
  return pose;
}

bool is_jointed(const btCollisionObject* object) {
  if (link_of(object) != nullptr) return true;
  const btRigidBody* const rigid = MovableObject(object).rigid();
  return rigid != nullptr && rigid->getNumConstraintRefs() > 0;
}

RigidVelocity velocity_of(const btCollisionObject& object) {
  if (const btRigidBody* const rigid = btRigidBody::upcast(&object)) {
    return {rigid->getLinearVelocity(), rigid->getAngularVelocity(),
            rigid->getCenterOfMassPosition()};
  }
  if (const btMultiBodyLinkCollider* const link = link_of(&object)) {
    RigidVelocity velocity = link_velocity(*link->m_multiBody, link->m_link);
    velocity.center = link->getWorldTransform().getOrigin();
    return velocity;
  }
  return {};
}

bool moves_finitely(const btCollisionObject& object) {
  const RigidVelocity velocity = velocity_of(object);
  const btTransform& pose = object.getWorldTransform();
  const btMatrix3x3& turn = pose.getBasis();
  return std::isfinite(velocity.linear.length2() + velocity.angular.length2() +
                       pose.getOrigin().length2() + turn[0].length2() + turn[1].length2() +
                       turn[2].length2());
}

// The rotation from its sine, not from the cosine of half of it, which says nothing of small ones in single precision.
RigidVelocity mean_velocity(const btTransform& from, const btTransform& to, btScalar time) {
  RigidVelocity velocity{(to.getOrigin() - from.getOrigin()) / time, {0, 0, 0}, to.getOrigin()};
  if (from.getBasis() == to.getBasis()) return velocity;
  const btMatrix3x3 turn = to.getBasis() * from.getBasis().transpose();
  const btVector3 twice_sine(turn[2][1] - turn[1][2], turn[0][2] - turn[2][0],
                             turn[1][0] - turn[0][1]);
  const btScalar sine = twice_sine.length() / 2;
  if (!(sine > 0)) return velocity;
  const btScalar cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2;
  velocity.angular = twice_sine * (btAtan2(sine, cosine) / (2 * sine * time));
  return velocity;
}

MovableObject::MovableObject(const btCollisionObject* object) {
  if (object == nullptr) return;
  auto* const rigid = const_cast<btRigidBody*>(btRigidBody::upcast(object));
  if (rigid != nullptr) {
    if (rigid->isStaticOrKinematicObject()) return;
    rigid_ = rigid;
    object_ = object;
    return;
  }
  btMultiBodyLinkCollider* const link = link_of(object);
  if (link == nullptr || !is_link_movable(*link->m_multiBody, link->m_link)) return;
  link_ = link;
  object_ = object;
}

const void* MovableObject::inertia_owner() const {
  if (rigid_ != nullptr) return rigid_;
  return link_ != nullptr ? link_->m_multiBody : nullptr;
}

bool MovableObject::is_articulated() const {
  return link_ != nullptr && link_->m_multiBody->getNumDofs() > 0;
}

btScalar MovableObject::inverse_mass() const {
  if (rigid_ != nullptr) return rigid_->getInvMass();
  return static_cast<btScalar>(1 / reference_mass(*link_->m_multiBody, link_->m_link));
}

btVector3 MovableObject::gravity() const {
  if (rigid_ != nullptr) return rigid_->getGravity();
  const btMultiBody& multibody = *link_->m_multiBody;
  const btVector3& force =
      link_->m_link < 0 ? multibody.getBaseForce() : multibody.getLinkForce(link_->m_link);
  return force * inverse_mass();
}

void MovableObject::activate() const {
  const_cast<btCollisionObject*>(object_)->activate();
  if (link_ != nullptr) link_->m_multiBody->wakeUp();
}

void MovableObject::set_pose(const btTransform& pose) const {
  if (rigid_ != nullptr) return rigid_->setCenterOfMassTransform(pose);
  link_->setWorldTransform(pose);
  link_->setInterpolationWorldTransform(pose);
  if (!is_articulated() && link_->m_link < 0) link_->m_multiBody->setBaseWorldTransform(pose);
}

bool MovableObject::is_placeable() const {
  if (object_->getActivationState() == DISABLE_SIMULATION) return false;
  if (rigid_ != nullptr) return true;
  return !is_articulated() && link_->m_link < 0;
}

void WrenchSum::add(const btCollisionObject* object, const btVector3& impulse,
                    const btVector3& point) {
  const MovableObject movable{object};
  if (!movable) return;
  auto entry = std::find_if(entries_.begin(), entries_.end(),
                            [&](const Entry& one) { return one.object == movable; });
  if (entry == entries_.end()) {
    entry = entries_.insert(entry, {movable, btVector3(0, 0, 0), btVector3(0, 0, 0)});
  }
  entry->impulse += impulse;
  entry->angular += (point - movable.center()).cross(impulse);
}

void WrenchSum::apply() const {
  for (const Entry& entry : entries_) {
    entry.object.activate();
    if (btRigidBody* const rigid = entry.object.rigid()) {
      rigid->applyCentralImpulse(entry.impulse);
      rigid->applyTorqueImpulse(entry.angular);
      continue;
    }
    btMultiBody& multibody = *entry.object.link()->m_multiBody;
    const MultiBodyInertia inertia(multibody);
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << from_bullet(entry.impulse), from_bullet(entry.angular);
    const VectorX<btScalar> change =
        inertia.response_to(inertia.jacobian_of(entry.object.link()->m_link).transpose() * wrench)
            .cast<btScalar>();
    multibody.applyDeltaVeeMultiDof(change.data(), 1);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
