#pragma once

// Tested by tests/bridge/contact/flat_patches_test.cpp.

#include <cstddef>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/face_tree.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Neighboring leaves of a tree of faces that are so flat together, all through a step, that they need not be searched for contacts
/// with each other. Each is one piece, and so are the faces around a node that they share.
///
/// A surface whose normals all are within a cone is the graph of a function over a plane: it meets itself only if its boundary does
/// so there (Volino and Magnenat-Thalmann 1994). Normals in a step of straight ways are within the cone of three of them (Tang et
/// al. 2009). In so narrow a cone as this one, places that are nearer than a distance are hardly farther apart on the surface.
class FlatPatches {
 public:
  /// Finds neighbors whose boundary does not come back near itself, by this distance [m]. body in its rest shape.
  void find_neighbors(const btSoftBody& body, const FaceTree& tree, btScalar distance);
  /// The body's boundary is another: nothing is flat any more.
  void forget() { neighbors_.clear(); }
  [[nodiscard]] bool is_forgotten() const { return neighbors_.empty(); }
  /// Normals of the step from m_q to m_x.
  void refit(const btSoftBody& body, const FaceTree& tree);
  /// Marks the leaves that are flat together with this one, beside other marks.
  void mark(std::size_t leaf, std::vector<char>& marks) const;
  /// Takes these marks away again.
  void unmark(std::size_t leaf, std::vector<char>& marks) const;
  static constexpr char kFlat = 2;

 private:
  struct Cone {
    btVector3 axis{0, 0, 0};
    btScalar angle = SIMD_PI;  ///< [rad] of the farthest normal
  };
  std::vector<std::vector<int>> neighbors_;  ///< of each leaf, itself too
  std::vector<Cone> cones_;
  int num_faces_ = 0;  ///< of the body then
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
