#pragma once

#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/bridge/contact/surface/hull_facets.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Contacts of a body with rigid objects by the laws of Signorini and Coulomb, instead of Bullet's iterations: a node
/// is pushed as far as the surface and no farther, and held sideways by kDF * friction times that impulse at most.
/// kKHR and kCHR have no say. A depth inside an object at rest that was there already when the step began gives no speed.
///
/// Bullet takes away a node's approach and kKHR or kCHR of its depth: a node stops where it was before the step and leaves with
/// up to that share of its speed. And it takes the share kDF * friction of the sideways motion per visit, however
/// lightly the node is pressed.
class RigidResponse {
 public:
  /// Whether a body's contacts can be solved so: without links, which would move the nodes afterwards, without clusters,
  /// and with Bullet's positions solved alone.
  [[nodiscard]] static bool fits(const btSoftBody& body);
  /// False for links of a btMultiBody: Bullet's visits know how these yield.
  [[nodiscard]] static bool knows(const btCollisionObject& object);

  void begin_step();
  /// Instead of btSoftBody::defaultCollisionHandler: contacts as add_rigid_contacts() finds them.
  void collide(btSoftBody& body, const btCollisionObjectWrapper& object, HullTable& hulls,
               btScalar time_step);
  /// Instead of btSoftBody::solveConstraints. Contacts go first; then Bullet solves the rest: anchors, contacts
  /// with cloth and with links of a btMultiBody. Dynamic objects get the impulses.
  void solve(btSoftBody& body);
  [[nodiscard]] int num_contacts() const { return static_cast<int>(contacts_.size()); }
  /// Appends those of the last step.
  void list_contacts(std::vector<RigidContact>& list) const {
    for (const Contact& contact : contacts_) {
      list.push_back(contact.with);
      list.back().impulse = contact.impulse;
      list.back().is_sticking = contact.is_sticking;
    }
  }

  /// For snapshots. Contacts are found anew in each step.
  void serialize(StateArchive& archive, int num_nodes) {
    if (archive.is_reading()) contacts_.clear();
    swept_.serialize(archive, num_nodes);
  }

 private:
  struct Contact {
    RigidContact with;  ///< where the object ends the step, before it is pushed
    btSoftBody::Node* node;
    btScalar friction;
    btRigidBody* moving;   ///< or nullptr
    btRigidBody* dynamic;  ///< the same, if impulses move it
    btVector3 lever;       ///< from its centre of mass [m]
    btMatrix3x3 impulses;  ///< from changes of the relative motion [m] to impulses [N s]
    btVector3 impulse;     ///< on the node, so far in this step [N s]
    bool is_sticking = false;
  };

  void project_out_of_planes(const btSoftBody& body);
  /// How far the node had to be moved with respect to the object [m].
  static btScalar visit(const btSoftBody& body, Contact& contact);
  void visit_all(const btSoftBody& body);

  SweptNodes swept_;
  std::vector<RigidContact> found_;
  std::vector<Contact> contacts_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
