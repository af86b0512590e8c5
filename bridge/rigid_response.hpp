#pragma once

#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/hull_facets.hpp>
#include <weft/bridge/precision.hpp>
#include <weft/bridge/rigid_contacts.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Contacts of a body with rigid objects by the laws of Signorini and Coulomb, in the place of Bullet's visits: a node
/// is pushed as far as the surface and no farther, and sideways held by kDF * friction times that push at most.
///
/// Bullet takes away a node's approach and kKHR or kCHR of its depth: a node stops where it was before the step and leaves with
/// up to that share of its speed. And it takes the share kDF * friction of the sideways motion per visit, however
/// lightly the node is pressed.
class RigidResponse {
 public:
  void begin_step() { are_ways_known_ = false; }
  /// In the place of btSoftBody::defaultCollisionHandler: contacts as add_rigid_contacts() finds them, into m_rcontacts.
  void collide(btSoftBody& body, const btCollisionObjectWrapper& object, HullTable& hulls,
               btScalar time_step);
  /// In the place of btSoftBody::solveConstraints. Contacts go first; then Bullet solves the rest: anchors and contacts
  /// with cloth. For bodies without links, which would move the nodes afterwards. Dynamic objects get the impulses.
  void solve(btSoftBody& body);

 private:
  struct Given {
    btScalar push = 0;        ///< along the normal, so far in this step [m]
    btVector3 hold{0, 0, 0};  ///< sideways [m]
  };

  /// How far the node had to be moved [m].
  btScalar visit(const btSoftBody& body, const btSoftBody::RContact& contact, Given& given) const;

  void visit_all(btSoftBody& body);

  NodeWays ways_;
  bool are_ways_known_ = false;  ///< of this step
  std::vector<RigidContact> found_;
  std::vector<Given> given_;  ///< of each contact
  btAlignedObjectArray<btSoftBody::RContact>
      contacts_;  ///< the body's, while Bullet solves the rest
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
