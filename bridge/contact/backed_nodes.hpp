#pragma once

// Tested by tests/bridge/implicit/cloth_between_test.cpp.

#include <algorithm>
#include <span>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/pinch.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/bridge/rigid/coupled_bodies.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/fast_solver/node_constraints.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Nodes that a dynamic rigid body presses on another surface, or into the corner between the two: a box on a tablecloth, a ball
/// that comes down on a rug. The body must be held up by the other surface through the cloth. The solver has one constraint for a
/// node, which is the body's; the other surface backs it (fast::NodeSupport). Fingers that joints hold are Pinches.
class BackedNodes {
 public:
  struct Backing {
    int node = 0;
    int contact = 0;  ///< with the body that presses: the solver's constraint
    int behind = 0;   ///< with the surface behind, which replaces that constraint
  };

  /// Without nodes that pinches hold.
  void find(std::span<const RigidContact> contacts, const btSoftBody& body, const Pinches& pinches);
  /// [m] Behind which a plane holds nothing: those of contacts that are replaced are moved back by so much.
  static constexpr btScalar kFarAway = 1000;
  /// Ascending by node.
  [[nodiscard]] const std::vector<Backing>& all() const { return backings_; }
  /// The springs of the surfaces behind, in order. planes: of the same contacts. starts: q [m], counted from the origin as planes.
  /// inertia_step: h' [s]. is_again: the step has been solved before; if not, the bodies' guesses become where nodes stop them.
  void make_supports(std::span<const RigidContact> contacts,
                     std::span<const fast::PlaneContact<btScalar>> planes,
                     const Matrix3X<btScalar>& starts, const Vector3<btScalar>& origin,
                     btScalar inertia_step, bool is_again, CoupledBodies& pushed,
                     std::vector<fast::NodeSupport<btScalar>>& supports) const;
  /// How much of the depth at which a node begins a step or substep inside of a surface it keeps there [m]; at once, it would be a
  /// kick. Nodes that a body or fingers have pressed in and then left come out as slowly as that body would, others by the end
  /// of the step. step_share: of the substep in the step [-]; least: what it keeps in any case, if it begins as deep [m].
  [[nodiscard]] btScalar depth_to_keep(const RigidContact& contact,
                                       const fast::PlaneContact<btScalar>& plane,
                                       const Matrix3X<btScalar>& starts, btScalar inertia_step,
                                       btScalar step_share, btScalar least) const;
  /// Remembers which nodes the step leaves inside of what is behind them, by more than rounding. gap_of(contact): in the solution [m].
  template <class Gap>
  void end_step(std::span<const RigidContact> contacts, const Pinches& pinches, btScalar margin,
                const Gap& gap_of) {
    if (backings_.empty() && sunken_.empty() && pinches.empty()) return;
    still_sunken_.clear();
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const RigidContact& contact = contacts[c];
      const bool was_pressed = is_behind(c) || pinches.has(contact.node) || pinches.is_beside(c);
      if (!was_pressed && !is_sunken(contact.node)) continue;
      if (gap_of(contact) < -kLeastDepth * margin) still_sunken_.push_back(contact.node);
    }
    std::sort(still_sunken_.begin(), still_sunken_.end());
    sunken_.swap(still_sunken_);
  }
  /// The sunken nodes, for snapshots.
  void serialize(StateArchive& archive, int num_nodes);
  /// How many nodes an object presses.
  [[nodiscard]] int num_pressed_by(const btCollisionObject& object) const;
  [[nodiscard]] bool is_behind(std::size_t contact) const {
    return !is_behind_.empty() && is_behind_[contact] != 0;
  }
  /// Also of nodes that are still inside of what was behind them.
  [[nodiscard]] bool has(int node) const;

 private:
  /// A node that is less deep has been left there by rounding [share of the margin].
  static constexpr btScalar kLeastDepth = btScalar(1e-3);
  [[nodiscard]] bool is_sunken(int node) const {
    return std::binary_search(sunken_.begin(), sunken_.end(), node);
  }
  struct Press {
    const btCollisionObject* object;
    int num_nodes;
  };
  std::vector<Backing> backings_;
  std::vector<char> is_behind_;  ///< for each contact; empty: none
  std::vector<int> order_;       ///< of contacts, ascending by node
  std::vector<Press> presses_;
  std::vector<int> sunken_;  ///< nodes, ascending
  std::vector<int> still_sunken_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
