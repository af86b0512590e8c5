#pragma once

// Tested by tests/bridge/rigid/gripper_test.cpp, tests/bridge/rigid/rigid_gripper_test.cpp.

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/fast_solver/node_constraints.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Nodes between two surfaces that leave no room for cloth and its margins: two fingers of a gripper, or a finger and a table.
/// The surfaces press on each other through the cloth, which Bullet solves as their contact; that force is what friction on
/// both sides of the cloth may count on, and all nodes between them share it alike. A node is held halfway between the surfaces,
/// by one of them. Beside the edges of fingers neighbors of such nodes touch both too: they may stay in the margins there, or stiff
/// cloth would be torn out of the grip by its own thickness.
///
/// This applies if a link of a multibody takes part, or a rigid body that Bullet lists a joint of, or two kinematic bodies do. The
/// force between kinematic bodies is not defined: they hold whatever they pinch.
class Pinches {
 public:
  /// time_step: of Bullet's step [s].
  void find(std::span<const RigidContact> contacts, const btSoftBody& body, btScalar time_step);
  /// Makes the plane of a contact that holds a pinched node the one halfway between both surfaces, and gives it the squeeze and the
  /// friction of the object on the other side times that of the cloth; other planes stay as they are. origin: that offsets are
  /// counted from [m].
  void press(std::size_t contact, btScalar friction, const Vector3<btScalar>& origin,
             fast::PlaneContact<btScalar>& plane) const {
    const Held& held = held_of(contact);
    if (!held.is_holding) return;
    plane.squeeze = held.squeeze;
    plane.squeeze_friction = friction * held.other_friction;
    plane.normal = from_bullet<btScalar>(held.normal);
    plane.offset = held.offset - plane.normal.dot(origin);
  }
  /// Whether the node of a contact is beside the edge of a finger, next to nodes that it pinches.
  [[nodiscard]] bool is_beside(std::size_t contact) const { return held_of(contact).is_beside; }
  /// How deep the node of a contact may stay behind its plane because it is there [m]; 0 elsewhere.
  [[nodiscard]] btScalar margin_beside(std::size_t contact, const btSoftBody& body) const {
    return is_beside(contact) ? body.getCollisionShape()->getMargin() : btScalar(0);
  }
  /// Whether another contact holds the node of this one.
  [[nodiscard]] bool is_replaced(std::size_t contact) const { return held_of(contact).is_replaced; }
  /// Gives fingers the reaction of the nodes that they hold: minus impulse_on(node) [N s] at position_of(node). Within the step a
  /// pinched node follows its surface as one that nothing moves.
  template <class Impulse, class Position>
  void push_back(std::span<const RigidContact> contacts, const Impulse& impulse_on,
                 const Position& position_of) {
    if (nodes_.empty()) return;
    WrenchSum sum;
    for (std::size_t c = 0; c < contacts.size() && c < held_.size(); ++c) {
      if (!held_[c].is_holding) continue;
      sum.add(contacts[c].object, -impulse_on(contacts[c].node), position_of(contacts[c].node));
    }
    sum.apply();
  }
  /// Nothing is left of the step before.
  void clear() {
    held_.clear();
    nodes_.clear();
  }
  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  /// Whether an object on a joint is one of two that may press nodes between them.
  [[nodiscard]] bool has_finger(const btCollisionObject* object) const {
    return is_jointed(object) && std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
             return pair.may_press && (pair.first == object || pair.second == object);
           });
  }
  [[nodiscard]] bool has(int node) const {
    return !nodes_.empty() && nodes_[static_cast<std::size_t>(node)] != 0;
  }

 private:
  struct Held {
    btScalar squeeze = 0;
    btVector3 normal{0, 0, 0};  ///< that of the plane halfway, out of the object
    btScalar offset = 0;        ///< [m]
    btScalar other_friction = 0;
    bool is_holding = false;
    bool is_replaced = false;
    bool is_beside = false;
  };
  /// Two objects that pinch nodes.
  struct Pair {
    const btCollisionObject* first = nullptr;
    const btCollisionObject* second = nullptr;
    int num_nodes = 0;
    btScalar force = 0;  ///< [N]
    bool may_press = false;
  };
  [[nodiscard]] const Held& held_of(std::size_t contact) const {
    static const Held kNone;
    return held_.empty() ? kNone : held_[contact];
  }
  [[nodiscard]] Pair& pair_of(const btCollisionObject* one, const btCollisionObject* other);
  /// contacts: pairs of them, each of a node with two objects.
  void find_beside(std::span<const RigidContact> contacts, const btSoftBody& body,
                   std::span<const std::pair<std::size_t, std::size_t>> of_nodes);

  std::vector<Held> held_;     ///< of each contact; empty: none is held
  std::vector<char> nodes_;    ///< flags; empty: none
  std::vector<int> first_of_;  ///< the first contact of each node, or -1
  std::vector<Pair> pairs_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
