#pragma once

// Tested by tests/bridge/rigid/multibody_test.cpp.

#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The velocity field of a rigid object.
struct RigidVelocity {
  btVector3 linear{0, 0, 0};   ///< of the center [m/s]
  btVector3 angular{0, 0, 0};  ///< [rad/s]
  btVector3 center{0, 0, 0};   ///< [m]

  [[nodiscard]] btVector3 at(const btVector3& point) const {
    return linear + angular.cross(point - center);
  }
  [[nodiscard]] bool is_zero() const { return linear.isZero() && angular.isZero(); }
};

/// The object as a link (or the base) of a btMultiBody, or nullptr.
[[nodiscard]] btMultiBodyLinkCollider* link_of(const btCollisionObject* object);

/// Whether it is a link, or a dynamic rigid body on a joint that was added with disableCollisionsBetweenLinkedBodies: Bullet lists
/// no others.
[[nodiscard]] bool is_jointed(const btCollisionObject* object);

/// The velocity of a rigid body or a link; zero for other objects.
[[nodiscard]] RigidVelocity velocity_of(const btCollisionObject& object);
/// Whether the pose and the velocity are finite. A soft body of Bullet's own that blows up takes rigid bodies with it.
[[nodiscard]] bool moves_finitely(const btCollisionObject& object);
/// Where a kinematic rigid body, which Bullet has moved already, was time_left [s] before the end of the step; of other objects the
/// present pose.
[[nodiscard]] btTransform kinematic_pose(const btCollisionObject& object, btScalar time_left);

/// The mean velocity from one pose to another, less than half a turn away, in time [s]; zero for equal poses, to the bit.
[[nodiscard]] RigidVelocity mean_velocity(const btTransform& from, const btTransform& to,
                                          btScalar time);

/// An object that impulses move: a dynamic rigid body, or a link of a multibody with a joint or a base that yields. The one
/// place that knows how the two differ, for contacts and anchors alike.
class MovableObject {
 public:
  MovableObject() = default;
  /// None if no impulse moves the object, or if there is no object.
  explicit MovableObject(const btCollisionObject* object);

  [[nodiscard]] explicit operator bool() const { return object_ != nullptr; }
  [[nodiscard]] bool operator==(const MovableObject& other) const {
    return object_ == other.object_;
  }
  [[nodiscard]] const btCollisionObject* object() const { return object_; }
  [[nodiscard]] btRigidBody* rigid() const { return rigid_; }
  [[nodiscard]] btMultiBodyLinkCollider* link() const { return link_; }
  /// The owner of the inertia: the rigid body, or the multibody.
  [[nodiscard]] const void* inertia_owner() const;
  /// A link whose motion joints constrain: what they do with an impulse in Bullet's next step (motors, limits) is not known.
  [[nodiscard]] bool is_articulated() const;

  /// The frame of the center of mass.
  [[nodiscard]] const btTransform& pose() const { return object_->getWorldTransform(); }
  [[nodiscard]] const btVector3& center() const { return pose().getOrigin(); }
  [[nodiscard]] RigidVelocity velocity() const { return velocity_of(*object_); }
  /// [1/kg] Of the object alone, reference_mass() of a link.
  [[nodiscard]] btScalar inverse_mass() const;
  /// [m/s^2] That the world's gravity, or the forces on a link, give it.
  [[nodiscard]] btVector3 gravity() const;
  void activate() const;
  /// Puts the object elsewhere; of an articulated link only its collider.
  void set_pose(const btTransform& pose) const;
  /// Whether it may be put elsewhere at the end of a step. Joints of rigid bodies draw them back in Bullet's next one.
  [[nodiscard]] bool is_placeable() const;

 private:
  const btCollisionObject* object_ = nullptr;
  btRigidBody* rigid_ = nullptr;
  btMultiBodyLinkCollider* link_ = nullptr;
};

/// Impulses on some objects, which are applied at once: the response of a multibody takes long to find.
class WrenchSum {
 public:
  /// impulse [N s] at a point; nothing for objects that no impulse moves.
  void add(const btCollisionObject* object, const btVector3& impulse, const btVector3& point);
  void apply() const;

 private:
  struct Entry {
    MovableObject object;
    btVector3 impulse;
    btVector3 angular;  ///< about the center
  };
  std::vector<Entry> entries_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
