#pragma once

// Tested by tests/bridge/rigid/multibody_test.cpp.

#include <span>
#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/bridge/rigid/movable_object.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The points at which friction holds nodes on links whose joints Bullet may hold back in its next step (motors, limits): the
/// displacement that a solution has given to a link never comes, and a node that had followed it would slip by that much in
/// each step. So a node that sticks is drawn to the point of the link at which it began to.
class StickingPoints {
 public:
  /// In the link's frame [m], or nullptr.
  [[nodiscard]] const btVector3* find(int node, const MovableObject& object) const;
  void begin_update() { next_.clear(); }
  /// A node in contact: a node that sticks keeps its point, others have theirs where they are, in the frame in which the
  /// solution leaves the link.
  void add(int node, const MovableObject& object, bool sticks, const btTransform& solved_pose,
           const btVector3& position);
  void end_update() { points_.swap(next_); }

 private:
  struct Point {
    int node;
    const btCollisionObject* link;  ///< only compared
    btVector3 local;                ///< [m]
  };
  std::vector<Point> points_;
  std::vector<Point> next_;
};

/// Links that no impulse moves, and how the program or Bullet leads them: Bullet knows no velocity of a kinematic base.
class LedLinks {
 public:
  void begin_step(btScalar time_step);
  /// A collider of such a link, found before Bullet's step and looked at after it: puts it to where the step ends.
  void follow(Collider& collider);

 private:
  struct Link {
    const btCollisionObject* object;  ///< only compared
    btTransform end;
    RigidVelocity velocity;
    bool is_of_this_step;
  };
  std::vector<Link> links_;
  btScalar time_step_ = 0;  ///< [s]
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
