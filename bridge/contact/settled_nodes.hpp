#pragma once

// Tested by tests/bridge/implicit/history/steady_step_test.cpp.

#include <algorithm>
#include <span>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Nodes for which a second look at a solid that stands still would find nothing new, once a solution has moved them: they have
/// a contact with it, have not come far, and are hardly behind its plane. All of a convex solid is behind the plane of a contact,
/// so that no other plane of it has them deeper.
class SettledNodes {
 public:
  /// How far a settled node is behind its plane at most, as a share of the margin [-].
  static constexpr btScalar kDepthShare = btScalar(0.4);

  /// contacts: all of the body. None are settled beside dynamic objects.
  void find(const btSoftBody& body, std::span<const RigidContact> contacts,
            const Collider& collider);
  /// For each node, or none.
  [[nodiscard]] std::span<const char> flags() const { return flags_; }
  [[nodiscard]] bool are_all() const {
    return !flags_.empty() && std::find(flags_.begin(), flags_.end(), 0) == flags_.end();
  }

 private:
  std::vector<char> flags_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
