#pragma once

// Tested by tests/bridge/contact/unfolded_windows_test.cpp.

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/face_tree.hpp>
#include <weft/core/eigen_alignment.hpp>

namespace weft::bridge {
struct PlaneBox;
inline namespace WEFT_BULLET_PRECISION {

/// Parts of a surface that cannot meet themselves in a step, found without looking for what is near what: most cloth, most of the
/// time.
///
/// A map of a convex region is injective if the symmetric part of its derivative is positive definite (Noshiro 1934, Warschawski
/// 1935). With a frame Q of two unit vectors and F the deformation gradient of the faces from a flat map of them, let m be the least
/// eigenvalue of sym(Q^T F). Integrated along the straight line on the map, two places that are r apart there are at least m r apart
/// in space. F of straight ways in a step lies between those of its ends, and so does m. No normals and no boundaries are compared:
/// a strip that curls up in its plane is found as well as a fold.
///
/// The map is the projection of the rest shape onto a plane. It is divided into blocks of a hundred faces, and each two by two of
/// them are a window, which counts if it is a convex region without holes and slits. Blocks that are in no unfolded window together
/// may meet if their boxes do.
class UnfoldedWindows {
 public:
  /// Where nodes are when a step begins, and when it ends.
  using Ways = std::span<const std::array<btVector3, 2>>;

  /// body in its rest shape. Finds no windows if that is not a graph over a plane.
  void find(const btSoftBody& body);
  /// No place of the surface is known to be apart from others: it is another one.
  void forget() {
    windows_.clear();
    are_all_apart_ = false;
  }
  /// How far apart places stay in an unfolded window, over their distance at rest [-].
  static constexpr btScalar kLeast = btScalar(0.7);

  /// ways: of the body's nodes; motion [m]: what the observer moves in the step; reach: what boxes keep from each other [m].
  void refit(Ways ways, const btVector3& motion, btScalar reach);
  /// No place comes near another one, but for those that are near each other at rest: the reach over kLeast.
  [[nodiscard]] bool are_all_apart() const { return are_all_apart_; }
  /// The same of the places of a face.
  [[nodiscard]] bool is_apart(int face) const {
    return !windows_.empty() &&
           may_meet_[static_cast<std::size_t>(block_of_[static_cast<std::size_t>(face)])] == 0;
  }

 private:
  /// Faces are worked on so many together.
  static constexpr std::size_t kLanes = 8;
  /// The derivative from the map to space is that of a face's edges in space times the inverse of those on the map [1/m].
  struct MappedFaces {
    std::vector<std::array<int, 3>> corners;
    std::array<std::vector<btScalar>, 4> inverses;  ///< by rows
  };
  struct Block {
    std::size_t first = 0, last = 0;  ///< of the mapped faces
    std::size_t num_faces = 0;        ///< of them, without those that fill up
    std::vector<int> nodes;
    std::array<btVector3, 2> directions;  ///< mean columns of F
    MotionBox box;
  };
  struct Window {
    bool is_whole = false;            ///< a convex region without holes and slits
    std::vector<std::size_t> others;  ///< mapped faces beside its blocks that it reaches into
    bool is_unfolded = false;
  };
  /// Two unit vectors, the one square to the other.
  using Frame = std::array<btVector3, 2>;
  /// Six numbers of F for each mapped face.
  using Gradients = std::array<std::vector<btScalar>, 6>;

  [[nodiscard]] int num_windows(int axis) const {
    return std::max(1, num_blocks_[static_cast<std::size_t>(axis)] - 1);
  }
  template <class Use>
  void for_blocks(int window, const Use& use) const;
  void make_blocks(const std::vector<std::array<int, 3>>& faces,
                   const std::vector<Eigen::Vector2d>& map, const PlaneBox& all);
  void find_whole_windows(const std::vector<Eigen::Vector2d>& map,
                          const std::vector<Eigen::Vector2d>& hull,
                          const std::vector<PlaneBox>& gaps);
  void find_gradients(Ways ways);
  [[nodiscard]] bool is_unfolded(int window) const;
  [[nodiscard]] bool are_unfolded(std::size_t first, std::size_t last, const Frame& frame) const;
  template <std::size_t kCount>
  [[nodiscard]] int num_folded(std::size_t first, const Frame& frame) const;
  [[nodiscard]] bool share_window(int one, int other) const;
  void find_meetings(btScalar reach);

  std::array<int, 2> num_blocks_{0, 0};
  std::vector<int> block_of_;  ///< of each face
  std::vector<Block> blocks_;  ///< row by row
  std::vector<Window> windows_;
  MappedFaces faces_;  ///< block by block, each filled up to whole lanes by its last face
  std::array<Gradients, 2> gradients_;  ///< where the step begins and ends
  std::vector<char> may_meet_;          ///< blocks
  std::vector<int> order_;              ///< of blocks along an axis
  bool are_all_apart_ = false;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
