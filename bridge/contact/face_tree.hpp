#pragma once

// Tested by tests/bridge/contact/cloth_contact_test.cpp.

#include <array>
#include <span>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/state_archive.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// A box, its fourth numbers unused [m].
struct MotionBox {
  std::array<btScalar, 4> low;
  std::array<btScalar, 4> high;

  /// The swept bounds of a node in this step, from m_q + shift to m_x.
  static MotionBox of(const btSoftBody::Node& node, const btVector3& shift) {
    return of(node.m_q + shift, node.m_x);
  }
  static MotionBox of(const btVector3& start, const btVector3& end);
  static MotionBox nowhere();
  void include(const MotionBox& other);
  /// By distance [m] to all sides.
  [[nodiscard]] MotionBox grown(btScalar distance) const;
};

/// Whether two boxes have a point in common.
[[nodiscard]] bool meet(const MotionBox& a, const MotionBox& b);

/// Nodes of a body in groups of neighbors, decided once from their first positions.
class NodeGroups {
 public:
  static constexpr int kLargest = 16;
  void arrange(const btSoftBody& body);
  /// Groups by their first nodes, and nodes within a group, ascending: threads that go through ranges of the groups have
  /// most of the nodes that they have in loops over nodes.
  void sort();
  [[nodiscard]] int num_nodes() const { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] std::size_t size() const { return starts_.empty() ? 0 : starts_.size() - 1; }
  [[nodiscard]] std::span<const int> operator[](std::size_t group) const {
    return std::span(nodes_).subspan(starts_[group], starts_[group + 1] - starts_[group]);
  }
  /// For a body of so many nodes.
  void serialize(StateArchive& archive, int num_nodes);

 private:
  std::vector<int> nodes_;
  std::vector<std::size_t> starts_;
};

/// The faces of a soft body in a tree of their swept bounds in a step, to be asked which of them may meet a
/// node. The order of the faces in the tree is decided once; boxes follow the body.
class FaceTree {
 public:
  static constexpr std::size_t kWidth = 16;  ///< faces of a leaf, compared at once

  /// Leaves that may meet some nodes, and memory to work with.
  struct Nearby {
    std::vector<int> leaves;
    std::array<std::vector<btScalar>, 3> low, high;  ///< of their boxes
    std::vector<int> apart;
    std::vector<int> slots;  ///< what collect() found
  };

  /// Boxes from m_q + shift to m_x, shift [m] being what the observer moves in the step. Allocates
  /// memory only if the number of faces is another.
  void refit(const btSoftBody& body, const btVector3& shift);
  /// The leaves whose boxes meet the box, but for those that are left out; empty: none is.
  void find(const MotionBox& box, Nearby& nearby, const std::vector<char>& is_left_out = {}) const;
  /// Slots, ascending, of the faces in the leaves found whose boxes meet the box.
  [[nodiscard]] std::span<const int> collect(const MotionBox& box, Nearby& nearby) const;
  /// False: the point lies beside the face of a slot by more than this share of it [-]. Where a cloth lies smooth, that holds of
  /// the faces near a node, and costs less than a contact that comes to nothing. True where a face is too thin to say.
  [[nodiscard]] bool may_be_over(int slot, const btVector3& point, btScalar overlap) const {
    const Weights& face = weights_[static_cast<std::size_t>(slot)];
    const btVector3 from_corner = point - face.corner;
    const btScalar of_b = btDot(face.slope_of_b, from_corner);
    const btScalar of_c = btDot(face.slope_of_c, from_corner);
    const btScalar least = -overlap - kRounding;
    return (static_cast<int>(of_b >= least) & static_cast<int>(of_c >= least) &
            static_cast<int>(1 - of_b - of_c >= least)) != 0;
  }
  /// Faces in groups of neighbors.
  [[nodiscard]] std::size_t num_leaves() const { return leaves_.size(); }
  [[nodiscard]] std::span<const int> faces_of_leaf(std::size_t leaf) const {
    return std::span(leaves_[leaf].faces).first(leaves_[leaf].size);
  }
  /// The face of a slot, which is an index into the tree.
  [[nodiscard]] int face(int slot) const {
    const auto index = static_cast<std::size_t>(slot);
    return leaves_[index / kWidth].faces[index % kWidth];
  }
  /// The order of the faces, for a body of so many.
  void serialize(StateArchive& archive, int num_faces);

 private:
  struct Leaf {
    std::array<std::array<btScalar, kWidth>, 3> low, high;  ///< nowhere where there is no face
    std::array<int, kWidth> faces;
    std::size_t size = 0;
  };
  /// Over the plane of a face, the barycentric weight of its second and third corner is a slope [1/m] times the distance to its
  /// first. Both are 0 where the face is too thin.
  struct Weights {
    btVector3 corner, slope_of_b, slope_of_c;
  };
  /// Rounding changes a weight by less [-], also where a face is so thin that it is multiplied by a hundred.
  static constexpr btScalar kRounding = btScalar(0.01);

  void arrange(const btSoftBody& body);
  void make_leaves(const std::vector<int>& order, const std::vector<std::size_t>& starts);
  void fill(Leaf& leaf, MotionBox& around) const;
  static Weights weights_of(const btSoftBody::Face& face);
  int* collect(int number, const MotionBox& box, int* next) const;

  std::vector<std::array<int, 3>> corners_;  ///< of each face
  std::vector<MotionBox> nodes_;
  std::vector<Leaf> leaves_;      ///< a power of two of them
  std::vector<Weights> weights_;  ///< by slot
  std::vector<MotionBox>
      boxes_;  ///< of 1 (the root), 2 and 3, ...; of leaf l at leaves_.size() + l
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
