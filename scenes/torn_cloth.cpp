#include <weft/scenes/torn_cloth.hpp>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/mesh/mesh_state.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft::scenes {

TornCloth::TornCloth(ClothMesh mesh, ClothTear tear)
    : mesh_(std::move(mesh)), tear_(std::move(tear)), num_first_nodes_(mesh_.num_nodes()) {
  check(tear_.rule, mesh_);
}

std::optional<Tear> TornCloth::first_cuts() const {
  Edges cut(2, 0);
  for (const Blade& blade : tear_.cuts) {
    const Edges more = edges_under(blade, mesh_, mesh_.rest_positions);
    const Eigen::Index old = cut.cols();
    cut.conservativeResize(2, old + more.cols());
    cut.rightCols(more.cols()) = more;
  }
  if (cut.cols() == 0) return std::nullopt;
  Tear tear = cut_along(mesh_, cut);
  if (!tear.any()) return std::nullopt;
  return tear;
}

std::optional<Tear> TornCloth::tear_at(ConstMatrix3XRef<double> positions) const {
  const Edges cut = edges_to_tear(mesh_, positions, tear_.rule);
  if (cut.cols() == 0) return std::nullopt;
  Tear tear = cut_along(mesh_, cut);
  if (!tear.any()) return std::nullopt;
  return tear;
}

void TornCloth::adopt(const Tear& tear) {
  ClothTopology topology;
  if (topology_) topology.origins = topology_->origins;
  const std::vector<int> before = topology.origins;
  for (const int origin : tear.origins) {
    topology.origins.push_back(origin < num_first_nodes_
                                   ? origin
                                   : before[static_cast<std::size_t>(origin - num_first_nodes_)]);
  }
  topology.triangles = tear.mesh.triangles;
  topology_ = std::make_shared<const ClothTopology>(std::move(topology));
  mesh_ = tear.mesh;
}

void TornCloth::serialize(StateArchive& archive) {
  archive.part("torn cloth");
  archive.expect(num_first_nodes_, "nodes before it tears");
  bool is_torn = topology_ != nullptr;
  archive.value(is_torn);
  if (!is_torn) return;
  weft::serialize(archive, mesh_);
  ClothTopology topology;
  if (topology_) topology = *topology_;
  archive.value(topology.origins);
  archive.value(topology.triangles);
  if (archive.is_reading()) topology_ = std::make_shared<const ClothTopology>(std::move(topology));
}

// The node of a triangle's corner that is new was, in the earlier mesh, the node of the same corner.
Tear TornCloth::tear_since(const TornCloth& earlier) const {
  const Triangles& before = earlier.mesh_.triangles;
  const Triangles& now = mesh_.triangles;
  const int num_before = earlier.mesh_.num_nodes();
  const int num_new = mesh_.num_nodes() - num_before;
  if (num_new < 0 || before.cols() != now.cols()) {
    throw Error("snapshot: torn cloth: " + std::to_string(mesh_.num_nodes()) +
                " nodes, expected at least the " + std::to_string(num_before) +
                " of the scene's cloth");
  }
  Tear tear{mesh_, std::vector<int>(static_cast<std::size_t>(num_new), -1)};
  for (Eigen::Index t = 0; t < now.cols(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int node = now(corner, t) - num_before;
      if (node >= 0) tear.origins[static_cast<std::size_t>(node)] = before(corner, t);
    }
  }
  if (std::find(tear.origins.begin(), tear.origins.end(), -1) != tear.origins.end()) {
    throw Error("snapshot: torn cloth: a node belongs to no triangle, expected one");
  }
  return tear;
}

ClothMesh drawn_mesh(const ClothMesh& mesh, const ClothTopology* topology) {
  if (topology == nullptr) return mesh;
  const int first = mesh.num_nodes();
  const int num_nodes = first + static_cast<int>(topology->origins.size());
  const auto fits = [&](int node) { return node >= 0 && node < num_nodes; };
  if (topology->triangles.cols() != mesh.triangles.cols() ||
      !std::all_of(topology->triangles.reshaped().begin(), topology->triangles.reshaped().end(),
                   fits)) {
    throw InvalidArgument("torn cloth: the triangles do not fit the mesh of the scene");
  }
  const auto origin_of = [&](int node) {
    return node < first ? node : topology->origins[static_cast<std::size_t>(node - first)];
  };
  ClothMesh drawn;
  drawn.triangles = topology->triangles;
  drawn.rest_positions.resize(3, num_nodes);
  const bool has_texture = mesh.texture_coordinates.cols() > 0;
  if (has_texture) drawn.texture_coordinates.resize(2, num_nodes);
  drawn.corner_texture_coordinates = mesh.corner_texture_coordinates;
  for (int node = 0; node < num_nodes; ++node) {
    drawn.rest_positions.col(node) = mesh.rest_positions.col(origin_of(node));
    if (!has_texture) continue;
    drawn.texture_coordinates.col(node) = mesh.texture_coordinates.col(origin_of(node));
  }
  const Edges whole = mesh.edges_of({"stretch"});
  std::set<std::pair<int, int>> is_stretch;
  for (Eigen::Index e = 0; e < whole.cols(); ++e) is_stretch.emplace(whole(0, e), whole(1, e));
  std::vector<int> kept;
  const Edges sides = edges_of_triangles(drawn.triangles);
  for (Eigen::Index e = 0; e < sides.cols(); ++e) {
    if (!is_stretch.contains(std::minmax({origin_of(sides(0, e)), origin_of(sides(1, e))})))
      continue;
    kept.insert(kept.end(), {sides(0, e), sides(1, e)});
  }
  drawn.edge_sets.push_back(
      {"stretch", Eigen::Map<const Edges>(kept.data(), 2, std::ssize(kept) / 2)});
  return drawn;
}

}  // namespace weft::scenes
