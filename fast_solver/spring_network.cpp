#include <weft/fast_solver/spring_network.hpp>

#include <map>
#include <utility>

#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/fast_solver/rest_stiffness.hpp>

namespace weft::fast {
namespace {

struct Entry {
  double rest_length = 0;
  double stiffness = 0;
  double compressed = 0;
  double damping = 0;
  double stabiliser = 0;
};
using Entries = std::map<std::pair<int, int>, Entry>;

bool is_bending(const forces::LawSpecification& law) {
  return law.law == "hinge_torsion" || law.law == "torsion";
}

void add_springs(const forces::LawSpecification& law, const ClothMesh& mesh, Entries& entries) {
  const Edges edges = forces::law_edges(law, mesh);
  const VectorX<double> lengths = forces::law_rest_lengths(law, mesh, edges);
  const bool is_tension = law.law == "tension";
  const double stiffness = is_tension ? forces::law_scalar(law, "stiffness") : 0.0;
  const double ratio = is_tension ? forces::law_scalar(law, "compression_ratio") : 1.0;
  const double damping = is_tension ? 0.0 : forces::law_scalar(law, "damping");
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    Entry& entry = entries[std::minmax(edges(0, e), edges(1, e))];
    entry.rest_length = lengths[e];
    entry.stiffness += stiffness;
    entry.compressed += ratio * stiffness;
    entry.damping += damping;
  }
}

}  // namespace

bool is_implicit(const forces::LawSpecification& law) {
  return law.law == "tension" || law.law == "spring_damping";
}

SpringNetwork make_network(const ClothMesh& mesh,
                           const std::vector<forces::LawSpecification>& laws) {
  Entries entries;
  std::vector<forces::LawSpecification> bending;
  for (const forces::LawSpecification& given : laws) {
    const forces::LawSpecification law = forces::checked(given);
    if (is_implicit(law)) add_springs(law, mesh, entries);
    if (is_bending(law)) bending.push_back(law);
  }
  for (const MatrixPart& part : rest_stiffness(mesh, bending)) {
    Entry& entry = entries[{part.row, part.column}];
    entry.stabiliser -= part.value;
    if (entry.rest_length > 0) continue;
    const double distance =
        (mesh.rest_positions.col(part.row) - mesh.rest_positions.col(part.column)).norm();
    entry.rest_length =
        distance > 0 ? distance : 1.0;  // of no spring, but a length to compare with
  }
  SpringNetwork network;
  const auto m = static_cast<Eigen::Index>(entries.size());
  network.edges.resize(2, m);
  for (auto* values : {&network.rest_lengths, &network.stiffness, &network.compressed_stiffness,
                       &network.damping, &network.stabiliser}) {
    values->resize(m);
  }
  Eigen::Index e = 0;
  for (const auto& [nodes, entry] : entries) {
    network.edges.col(e) << nodes.first, nodes.second;
    network.rest_lengths[e] = entry.rest_length;
    network.stiffness[e] = entry.stiffness;
    network.compressed_stiffness[e] = entry.compressed;
    network.damping[e] = entry.damping;
    network.stabiliser[e] = entry.stabiliser;
    ++e;
  }
  return network;
}

}  // namespace weft::fast
