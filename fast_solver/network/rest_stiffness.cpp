#include <weft/fast_solver/network/rest_stiffness.hpp>

#include <algorithm>
#include <utility>

#include <weft/custom_forces/registry.hpp>

namespace weft::fast {

std::vector<MatrixPart> rest_stiffness(const ClothMesh& mesh,
                                       const std::vector<forces::LawSpecification>& laws) {
  const Matrix3X<double> no_velocities = Matrix3X<double>::Zero(3, mesh.num_nodes());
  const forces::State<double> rest{mesh.rest_positions, no_velocities, mesh.masses, 0.0};
  std::vector<forces::PairStiffness<double>> pairs;
  for (const forces::LawSpecification& law : laws) {
    forces::make_law<double>(law, mesh)->add_rest_stiffness(rest, pairs);
  }
  for (auto& pair : pairs)
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
  // Stable: elements are summed in their own order.
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& one, const auto& other) {
    return std::pair(one.first, one.second) < std::pair(other.first, other.second);
  });
  std::vector<MatrixPart> parts;
  for (const auto& pair : pairs) {
    if (parts.empty() || parts.back().row != pair.first || parts.back().column != pair.second) {
      parts.push_back({pair.first, pair.second, 0.0});
    }
    parts.back().value += pair.trace;
  }
  std::erase_if(parts, [](const MatrixPart& part) { return part.value == 0; });
  return parts;
}

}  // namespace weft::fast
