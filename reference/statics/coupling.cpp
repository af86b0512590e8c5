#include <weft/reference/statics/coupling.hpp>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft::reference {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

template <class Elements>
void add_all_pairs(const Elements& elements, Pairs& pairs) {
  for (Eigen::Index e = 0; e < elements.cols(); ++e) {
    for (Eigen::Index a = 0; a < elements.rows(); ++a) {
      for (Eigen::Index b = 0; b < a; ++b) {
        if (elements(a, e) == elements(b, e)) continue;
        pairs.emplace_back(std::minmax(elements(a, e), elements(b, e)));
      }
    }
  }
}

void add_connections(const ClothMesh& mesh, Pairs& pairs) {
  for (const ConnectionSet& set : mesh.connection_sets) {
    const std::vector<int> centres(set.connections.row(0).begin(), set.connections.row(0).end());
    const std::vector<Ring> all_rings = rings(mesh.triangles, centres);
    for (Eigen::Index e = 0; e < set.connections.cols(); ++e) {
      Eigen::VectorXi nodes(2);
      nodes << set.connections(0, e), set.connections(1, e);
      for (const int node : all_rings[static_cast<std::size_t>(e)].nodes) {
        nodes.conservativeResize(nodes.size() + 1);
        nodes[nodes.size() - 1] = node;
      }
      add_all_pairs(nodes, pairs);
    }
  }
}

Edges pairs_of(const ClothMesh& mesh, const std::set<forces::ElementKind>& kinds) {
  Pairs pairs;
  using Kind = forces::ElementKind;
  if (kinds.count(Kind::kEdges) != 0) {
    for (const EdgeSet& set : mesh.edge_sets) add_all_pairs(set.edges, pairs);
  }
  if (kinds.count(Kind::kLines) != 0) {
    for (const LineSet& set : mesh.line_sets) add_all_pairs(set.triples, pairs);
  }
  if (kinds.count(Kind::kHinges) != 0) add_all_pairs(bending_hinges(mesh), pairs);
  if (kinds.count(Kind::kFaces) != 0) add_all_pairs(mesh.triangles, pairs);
  if (kinds.count(Kind::kConnections) != 0) add_connections(mesh, pairs);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  Edges coupled(2, static_cast<Eigen::Index>(pairs.size()));
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    coupled.col(static_cast<Eigen::Index>(p)) << pairs[p].first, pairs[p].second;
  }
  return coupled;
}

}  // namespace

Edges coupled_nodes(const Body& body) {
  std::set<forces::ElementKind> kinds;
  for (const auto& law : body.laws.laws()) {
    const forces::LawInfo& info = law->info();
    if (info.traits.needs_closed_surface) {
      throw InvalidArgument("statics: law '" + std::string(info.id) +
                            "' couples every node with every other, expected laws of short reach");
    }
    kinds.insert(info.traits.elements);
  }
  return pairs_of(body.mesh, kinds);
}

bool has_short_reach(const forces::LawTraits& traits) {
  using Kind = forces::ElementKind;
  const bool is_local = traits.elements == Kind::kEdges || traits.elements == Kind::kLines ||
                        traits.elements == Kind::kHinges || traits.elements == Kind::kFaces;
  return is_local && !traits.needs_closed_surface;
}

Edges nearly_coupled_nodes(const Body& body) {
  std::set<forces::ElementKind> kinds;
  for (const auto& law : body.laws.laws()) {
    const forces::LawTraits& traits = law->info().traits;
    if (has_short_reach(traits)) kinds.insert(traits.elements);
  }
  return pairs_of(body.mesh, kinds);
}

std::vector<int> column_colors(const Edges& coupled, int num_nodes) {
  std::vector<std::vector<int>> neighbors(static_cast<std::size_t>(num_nodes));
  for (int node = 0; node < num_nodes; ++node) {
    neighbors[static_cast<std::size_t>(node)].push_back(node);
  }
  for (Eigen::Index e = 0; e < coupled.cols(); ++e) {
    neighbors[static_cast<std::size_t>(coupled(0, e))].push_back(coupled(1, e));
    neighbors[static_cast<std::size_t>(coupled(1, e))].push_back(coupled(0, e));
  }
  std::vector<int> colors(static_cast<std::size_t>(num_nodes), -1);
  std::vector<int> last_user;  // of each colour: the node that saw it taken last
  for (int node = 0; node < num_nodes; ++node) {
    for (const int row : neighbors[static_cast<std::size_t>(node)]) {
      for (const int other : neighbors[static_cast<std::size_t>(row)]) {
        const int color = colors[static_cast<std::size_t>(other)];
        if (color >= 0) last_user[static_cast<std::size_t>(color)] = node;
      }
    }
    const auto free =
        std::find_if(last_user.begin(), last_user.end(), [&](int user) { return user != node; });
    colors[static_cast<std::size_t>(node)] = static_cast<int>(free - last_user.begin());
    if (free == last_user.end()) last_user.push_back(-1);
  }
  return colors;
}

}  // namespace weft::reference
