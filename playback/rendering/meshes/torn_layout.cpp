#include <weft/playback/rendering/meshes/torn_layout.hpp>

#include <weft/scenes/torn_cloth.hpp>

namespace weft::scenes {

TornLayout::TornLayout(const ClothMesh& mesh) : whole_(make_layout(mesh)) {}

const ClothLayout& TornLayout::of(const ClothMesh& mesh, const ClothState& cloth) {
  if (!cloth.topology) return whole_;
  if (cloth.topology != topology_) {
    const ClothMesh drawn = drawn_mesh(mesh, cloth.topology.get());
    torn_ = make_layout(drawn);
    // Patterns count from the centre of the whole cloth; a node that is there twice must not shift them.
    const Eigen::Vector3f shift =
        (drawn.rest_positions.rowwise().mean() - mesh.rest_positions.rowwise().mean())
            .cast<float>();
    for (Eigen::Vector3f& place : torn_.rest_places) place += shift;
    topology_ = cloth.topology;
  }
  return torn_;
}

}  // namespace weft::scenes
