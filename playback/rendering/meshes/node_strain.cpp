#include <cmath>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/renderer.hpp>

namespace weft::scenes {

Eigen::VectorXd node_strain(const ClothMesh& mesh, ConstMatrix3XRef<double> positions) {
  if (positions.cols() != mesh.num_nodes()) {
    throw InvalidArgument(fmt::format("node_strain: positions = {} nodes, expected {} as the mesh",
                                      positions.cols(), mesh.num_nodes()));
  }
  // What the bones lead, as the skin of a character, has no springs.
  const Edges edges = mesh.has_edge_set("stretch") ? mesh.edges_of({"stretch"}) : Edges(2, 0);
  const Eigen::VectorXd rest = edge_lengths(mesh.rest_positions, edges);
  const Eigen::VectorXd length = edge_lengths(positions, edges);
  Eigen::VectorXd strain = Eigen::VectorXd::Zero(mesh.num_nodes());
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const double value = length[e] / rest[e] - 1.0;
    for (const int node : {edges(0, e), edges(1, e)}) {
      // A NaN of a blown-up state is kept, instead of losing every comparison.
      if (std::isnan(strain[node])) continue;
      if (!(std::abs(value) <= std::abs(strain[node]))) strain[node] = value;
    }
  }
  return strain;
}

}  // namespace weft::scenes
