#pragma once

// Tested by tests/custom_forces/laws/damping/rotation_damping_test.cpp, tests/custom_forces/laws/damping/acceleration_damping_test.cpp.

#include <vector>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// The nodes of a mesh that are not pinned, for laws that act on a body as a whole.
class FreeNodes {
 public:
  explicit FreeNodes(const ClothMesh& mesh);

  /// Sorted node indices, for a body with this many nodes. Throws InvalidArgument for the state of
  /// another mesh.
  [[nodiscard]] const std::vector<int>& of(Eigen::Index num_nodes) const {
    if (num_nodes != num_nodes_) refuse(num_nodes);
    return nodes_;
  }

 private:
  [[noreturn]] void refuse(Eigen::Index num_nodes) const;

  std::vector<int> nodes_;
  Eigen::Index num_nodes_;  ///< pinned ones too
};

}  // namespace weft::forces
