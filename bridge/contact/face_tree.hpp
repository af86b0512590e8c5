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
  static MotionBox of(const btSoftBody::Node& node, const btVector3& shift);
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
  /// The leaves whose boxes meet the box.
  void find(const MotionBox& box, Nearby& nearby) const;
  /// Slots, ascending, of the faces in the leaves found whose boxes meet the box.
  [[nodiscard]] std::span<const int> collect(const MotionBox& box, Nearby& nearby) const;
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

  void arrange(const btSoftBody& body);
  void make_leaves(const std::vector<int>& order, const std::vector<std::size_t>& starts);
  void fill(Leaf& leaf, MotionBox& around) const;
  int* collect(int number, const MotionBox& box, int* next) const;

  std::vector<std::array<int, 3>> corners_;  ///< of each face
  std::vector<MotionBox> nodes_;
  std::vector<Leaf> leaves_;  ///< a power of two of them
  std::vector<MotionBox>
      boxes_;  ///< of 1 (the root), 2 and 3, ...; of leaf l at leaves_.size() + l
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
