#include "bench/laws/law_cases.hpp"

#include <algorithm>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft::bench {
namespace {

using forces::ElementKind;

std::vector<double> typical_value(const forces::ParameterInfo& parameter, double size) {
  if (parameter.size == 3) return {0.3 * size, -9.81 * size, 0.1 * size};
  if (parameter.maximum < forces::ParameterInfo{}.maximum) {
    return {parameter.minimum + 0.5 * (parameter.maximum - parameter.minimum)};
  }
  return {parameter.minimum + size};
}

forces::LawSpecification typical(const forces::LawInfo& info, double size) {
  forces::LawSpecification result{.law = std::string(info.id), .sets = {}, .parameters = {}};
  for (const forces::ParameterInfo& parameter : info.parameters) {
    if (!parameter.required) continue;
    result.parameters[std::string(parameter.name)] = typical_value(parameter, size);
  }
  return forces::checked(result);
}

struct Count {
  std::string element;
  double number;
};

Count count_elements(ElementKind kind, const ClothMesh& mesh) {
  double number = 0;
  switch (kind) {
    case ElementKind::kEdges:
      return {"spring", static_cast<double>(mesh.num_edges())};
    case ElementKind::kLines:
      for (const LineSet& set : mesh.line_sets) number += static_cast<double>(set.triples.cols());
      return {"line", number};
    case ElementKind::kHinges:
      return {"hinge", static_cast<double>(bending_hinges(mesh).cols())};
    case ElementKind::kFaces:
      return {"face", static_cast<double>(mesh.triangles.cols())};
    case ElementKind::kConnections:
      for (const ConnectionSet& set : mesh.connection_sets) {
        number += static_cast<double>(set.connections.cols());
      }
      return {"connection", number};
    case ElementKind::kNodeSets:
      for (const NodeSet& set : mesh.node_sets) number += static_cast<double>(set.nodes.size());
      return {"node", number};
    case ElementKind::kNodes:
      break;
  }
  return {"node", static_cast<double>(mesh.num_nodes())};
}

}  // namespace

ClothMesh classic_cloth() {
  ClothGrid grid;
  grid.nodes = {50, 50};
  grid.size = {7, 7};
  ClothMesh mesh = make_cloth_grid(grid);
  std::vector<int> rim;
  for (int i = 0; i < 50; ++i) {
    for (int j = 0; j < 50; ++j) {
      if (i == 0 || j == 0 || i == 49 || j == 49) rim.push_back(grid_node(grid, i, j));
    }
  }
  connect(mesh, "rim", grid_node(grid, 25, 25), rim);
  std::sort(rim.begin(), rim.end());
  mesh.node_sets.push_back({"rim", rim});
  return mesh;
}

std::vector<LawCase> law_cases(const ClothMesh& cloth, double size) {
  std::vector<LawCase> cases;
  for (const forces::LawInfo* info : forces::all_laws()) {
    const ClothMesh mesh =
        info->traits.needs_closed_surface ? make_icosphere({.frequency = 16}) : cloth;
    const Count count = count_elements(info->traits.elements, mesh);
    cases.push_back(
        {std::string(info->id), count.element, count.number, mesh, typical(*info, size)});
  }
  return cases;
}

}  // namespace weft::bench
