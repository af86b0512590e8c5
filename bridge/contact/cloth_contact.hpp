#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/face_tree.hpp>
#include <weft/bridge/contact/flat_patches.hpp>
#include <weft/bridge/contact/unfolded_windows.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// What a cloth collides with beside rigid bodies.
struct ClothContactSettings {
  bool with_itself = false;
  bool with_others = false;      ///< with every other body that says so too
  double self_thickness = 0.02;  ///< [m] distance that its layers keep, > 0
  double margin = 0.01;          ///< [m] its share of the distance to another body, > 0
  double friction = 0.5;         ///< Coulomb coefficient [-]; with another body: the product, >= 0
};

/// The properties that all contacts of two bodies in a step share.
struct ContactRules {
  btScalar thickness;  ///< [m]
  btScalar friction;   ///< Coulomb [-]
  btScalar time_step;  ///< [s]
  int iterations;
};

/// Contact of cloth with cloth: nodes against faces, found here and solved by Bullet.
///
/// Bullet's own (VF_SS) leaves a body's own faces out, takes the side from where the step would end,
/// and solves one body after the other, so that what a later body gives an earlier one moves it and
/// is lost: of two free cloths that meet, a tenth of the momentum is left. Here the side is that of
/// the start of the step, or the outside of a body whose faces enclose a volume, a contact takes away the approach, and what is left of the thickness
/// slowly, and SoftBodySolver derives all velocities once all are solved. It goes into
/// btSoftBody::m_scontacts, so that Bullet's own iterations solve it together with its links.
/// Edges against edges are not looked at here: let the thickness be half the spacing of the nodes or
/// more, if no LayerImpacts follow.
class ClothContact {
 public:
  /// body in its rest shape: faces that are closer to a node than the thickness there, and its own,
  /// are never in contact with it. Throws InvalidArgument for settings out of their domain.
  ClothContact(const btSoftBody& body, const ClothContactSettings& settings);

  [[nodiscard]] const ClothContactSettings& settings() const { return settings_; }
  /// Its faces have an outside.
  [[nodiscard]] bool encloses_volume() const { return !outward_.empty(); }
  /// From now on with others too. margin [m] > 0, friction [-] >= 0.
  void meet_others(double margin, double friction) {
    settings_.with_others = true;
    settings_.margin = margin;
    settings_.friction = friction;
  }
  /// Nodes of the body were split (tearing.hpp): origins are the nodes that those appended were.
  void add_copies(const btSoftBody& body, const std::vector<int>& origins);
  /// Before btSoftBody::predictMotion: the body will be elsewhere.
  void begin_step() { is_of_this_step_ = false; }
  /// After btSoftBody::predictMotion, before contacts with cloth are projected: where nodes are then is where contacts are
  /// looked for. time_step [s].
  void add_self_contacts(btSoftBody& body, btScalar time_step);
  /// Contacts of the body's nodes with the faces of another one; add both ways. Likewise.
  /// Returns whether a node began the step inside of the other body, if its faces enclose a volume.
  bool add_contacts(btSoftBody& body, btSoftBody& other, ClothContact& other_contact,
                    btScalar time_step);

  /// The faces, where the step from m_q to m_x leads them.
  struct Faces {
    const FaceTree& tree;
    const FlatPatches& flat;  ///< none of a body that does not meet itself
    /// Leaves that come near no other place of the body: kApart, others: 0. Of a body that meets itself.
    const std::vector<char>& marks;
    btVector3 motion;  ///< [m] mean of the nodes', which the tree's boxes are without
  };
  [[nodiscard]] Faces faces(const btSoftBody& body);
  /// Whether the body meets itself nowhere on that way, without a search.
  [[nodiscard]] bool is_apart_from_itself(const btSoftBody& body);
  static constexpr char kApart = 1;

  /// How nodes and faces are sorted, for snapshots.
  void serialize(StateArchive& archive, const btSoftBody& body);

 private:
  void look(const btSoftBody& body);
  void look_if_moved(const btSoftBody& body);
  void refit_tree(const btSoftBody& body);
  /// Which faces are closer to a node than the thickness, and its own: they are never in contact with it.
  void note_near(const btSoftBody& body);
  void note_leaves(const btSoftBody& body);
  void add_self_contacts(btSoftBody& body, int node, std::span<const int> slots,
                         const ContactRules& rules) const;
  template <class Use>
  void for_candidates(const btSoftBody& body, btScalar reach, const ClothContact& faces,
                      const Use& use);

  /// For faces that enclose a volume: the contacts of another body's node with them. slots: of those that it may meet.
  bool add_contacts_outside(btSoftBody& body, btSoftBody::Node& node, btSoftBody& other,
                            std::span<const int> slots, const ContactRules& rules) const;
  [[nodiscard]] int nearest_face(const btVector3& point, const btSoftBody& body,
                                 std::span<const int> slots) const;
  [[nodiscard]] btScalar height_over(const btVector3& point, const btSoftBody& body,
                                     int face) const;

  ClothContactSettings settings_;
  std::vector<signed char> outward_;  ///< outward_faces() of the body
  FaceTree tree_;
  FlatPatches flat_;
  std::vector<std::vector<int>> nodes_of_leaf_;  ///< each node once
  std::vector<int> loose_nodes_;                 ///< of no face
  UnfoldedWindows windows_;
  std::vector<char> marks_;  ///< of leaves: why they are not looked at
  btVector3 motion_;         ///< [m] mean of the body's nodes, of the step that is seen
  bool is_of_this_step_ = false;
  std::vector<std::array<btVector3, 2>> seen_;  ///< m_q and m_x of the nodes
  bool is_tree_fitted_ = false;                 ///< to them
  bool is_known_apart_ = false;                 ///< it meets itself nowhere, there
  NodeGroups groups_;
  FaceTree::Nearby nearby_;
  std::vector<std::vector<int>> near_at_rest_;  ///< per node: slots of the tree, ascending
  int num_near_faces_ = 0;                      ///< that the body had then
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
