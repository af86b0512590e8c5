#include <weft/custom_forces/law_input.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <weft/core/error.hpp>

namespace weft::forces {
namespace {

const std::vector<double>& values_of(const LawSpecification& specification,
                                     std::string_view parameter) {
  const auto found = specification.parameters.find(parameter);
  if (found == specification.parameters.end()) {
    throw InvalidArgument(specification.law + ": parameter '" + std::string(parameter) +
                          "' is missing, expected a value");
  }
  return found->second;
}

}  // namespace

double law_scalar(const LawSpecification& specification, std::string_view parameter) {
  return values_of(specification, parameter).at(0);
}

Vector3<double> law_vector(const LawSpecification& specification, std::string_view parameter) {
  const std::vector<double>& values = values_of(specification, parameter);
  return {values.at(0), values.at(1), values.at(2)};
}

Edges law_edges(const LawSpecification& specification, const ClothMesh& mesh) {
  for (const std::string& name : specification.sets) {
    if (mesh.has_edge_set(name)) continue;
    std::string known;
    for (const EdgeSet& set : mesh.edge_sets) known += (known.empty() ? "" : ", ") + set.name;
    throw InvalidArgument(specification.law + ": edge_sets = '" + name +
                          "', expected sets of the mesh: " + known);
  }
  std::vector<std::string> names = specification.sets;
  if (names.empty()) {
    for (const EdgeSet& set : mesh.edge_sets) names.push_back(set.name);
  }
  Edges edges = mesh.edges_of(names);
  if (edges.size() > 0 && (edges.minCoeff() < 0 || edges.maxCoeff() >= mesh.num_nodes())) {
    throw InvalidArgument(specification.law + ": an edge names a node outside 0 to " +
                          std::to_string(mesh.num_nodes() - 1));
  }
  return edges;
}

VectorX<double> law_rest_lengths(const LawSpecification& specification, const ClothMesh& mesh,
                                 const Edges& edges) {
  VectorX<double> lengths = edge_lengths(mesh.rest_positions, edges);
  for (Eigen::Index e = 0; e < lengths.size(); ++e) {
    if (!(lengths[e] > 0) || !std::isfinite(lengths[e])) {
      throw InvalidArgument(specification.law + ": rest length of the edge between nodes " +
                            std::to_string(edges(0, e)) + " and " + std::to_string(edges(1, e)) +
                            " = " + std::to_string(lengths[e]) + " [m], expected > 0 and finite");
    }
  }
  return lengths;
}

std::vector<int> law_nodes(const LawSpecification& specification, const ClothMesh& mesh) {
  std::string known;
  for (const NodeSet& set : mesh.node_sets) known += (known.empty() ? "" : ", ") + set.name;
  std::vector<int> nodes;
  const auto add = [&](const NodeSet& set) {
    nodes.insert(nodes.end(), set.nodes.begin(), set.nodes.end());
  };
  for (const std::string& name : specification.sets) {
    const auto found = std::find_if(mesh.node_sets.begin(), mesh.node_sets.end(),
                                    [&](const NodeSet& set) { return set.name == name; });
    if (found == mesh.node_sets.end()) {
      throw InvalidArgument(specification.law + ": node_sets = '" + name +
                            "', expected sets of the mesh: " + known);
    }
    add(*found);
  }
  if (specification.sets.empty()) {
    for (const NodeSet& set : mesh.node_sets) add(set);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (!nodes.empty() && (nodes.front() < 0 || nodes.back() >= mesh.num_nodes())) {
    throw InvalidArgument(specification.law + ": a node set names a node outside 0 to " +
                          std::to_string(mesh.num_nodes() - 1));
  }
  return nodes;
}

Triangles law_faces(const LawSpecification& specification, const ClothMesh& mesh) {
  const Triangles& faces = mesh.triangles;
  if (faces.size() > 0 && (faces.minCoeff() < 0 || faces.maxCoeff() >= mesh.num_nodes())) {
    throw InvalidArgument(specification.law + ": a triangle names a node outside 0 to " +
                          std::to_string(mesh.num_nodes() - 1));
  }
  return faces;
}

}  // namespace weft::forces
