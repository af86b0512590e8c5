#pragma once

// Tested by tests/bridge/implicit/fast_body_test.cpp, tests/bridge/contact/terrain_test.cpp.

#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The contacts of each node of a body, to be asked whether one that is found is among them.
class KnownContacts {
 public:
  /// By how much a plane may be wrong where the node has come to, as a share of the margin [-].
  static constexpr btScalar kPlaneShare = btScalar(0.02);

  void list(const std::vector<RigidContact>& contacts, int num_nodes);
  /// The contact that is known of the node and the collider, among those that were listed; more may have been appended.
  /// Triangles of a concave collider that make one plane where the node is are one contact.
  [[nodiscard]] RigidContact* find(const RigidContact& found, const btVector3& position,
                                   btScalar margin, std::vector<RigidContact>& contacts) const;

 private:
  std::vector<int> last_of_node_;  ///< or -1
  std::vector<int> one_before_;    ///< for each contact: another one of its node, or -1
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
