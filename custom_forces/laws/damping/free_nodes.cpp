#include <weft/custom_forces/laws/damping/free_nodes.hpp>

#include <algorithm>
#include <string>

#include <weft/core/error.hpp>

namespace weft::forces {

FreeNodes::FreeNodes(const ClothMesh& mesh) : num_nodes_(mesh.num_nodes()) {
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (!std::binary_search(mesh.pinned.begin(), mesh.pinned.end(), node)) nodes_.push_back(node);
  }
}

void FreeNodes::refuse(Eigen::Index num_nodes) const {
  throw InvalidArgument("law of a whole body: num_nodes = " + std::to_string(num_nodes) +
                        " [1], expected the " + std::to_string(num_nodes_) + " of its mesh");
}

}  // namespace weft::forces
