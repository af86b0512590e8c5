#include <weft/fast_solver/isotropic_network.hpp>

#include <cstddef>
#include <utility>

namespace weft::fast {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

IsotropicNetwork isotropic_network(const SpringNetwork& network, int num_nodes,
                                   const std::vector<int>& names) {
  std::vector<int> unknown_of(at(num_nodes), -1);
  IsotropicNetwork result;
  SymmetricMatrix& matrix = result.matrix;
  for (const int node : names) {
    unknown_of[at(node)] = matrix.size();
    matrix.diagonal.push_back(0);
  }
  const auto ends = [&](Eigen::Index e) {
    return std::pair(unknown_of[at(network.edges(0, e))], unknown_of[at(network.edges(1, e))]);
  };
  matrix.starts.assign(names.size() + 1, 0);
  for (Eigen::Index e = 0; e < network.edges.cols(); ++e) {
    const auto [a, b] = ends(e);
    if (a < 0 || b < 0) continue;
    ++matrix.starts[at(a) + 1];
    ++matrix.starts[at(b) + 1];
  }
  for (std::size_t i = 0; i < names.size(); ++i) matrix.starts[i + 1] += matrix.starts[i];
  matrix.columns.resize(at(matrix.starts.back()));
  matrix.values.resize(matrix.columns.size());
  result.lengths.resize(matrix.columns.size());
  std::vector<int> next(matrix.starts.begin(), matrix.starts.end() - 1);
  const auto add = [&](int row, int column, double value, double length) {
    const std::size_t place = at(next[at(row)]++);
    matrix.columns[place] = column;
    matrix.values[place] = value;
    result.lengths[place] = length;
  };
  // Columns come in ascending order: of lower nodes before those that have the node as their first one.
  for (Eigen::Index e = 0; e < network.edges.cols(); ++e) {
    const double weight =
        network.stiffness[e] + network.damping[e] / kTimeStep + network.stabiliser[e];
    const auto [a, b] = ends(e);
    if (a >= 0) matrix.diagonal[at(a)] += weight;
    if (b >= 0) matrix.diagonal[at(b)] += weight;
    if (a < 0 || b < 0) continue;
    add(a, b, -weight, network.rest_lengths[e]);
    add(b, a, -weight, network.rest_lengths[e]);
  }
  return result;
}

}  // namespace weft::fast
