#include <weft/fast_solver/global_correction.hpp>

#include <algorithm>
#include <utility>

#include <weft/fast_solver/minimum_degree.hpp>

namespace weft::fast {
namespace {

/// Coarse unknowns up to which no coarser ones are looked for: so many, or this share of all. Their factor is
/// read in a fraction of the time that the other parts of an iteration take, and every further
/// level leaves out more than one smoothing can do.
constexpr int kFewEnough = 8000;
constexpr double kSmallShare = 0.05;
/// The next coarser ones must be fewer by this to be worth it.
constexpr double kLeastGain = 0.7;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

GlobalCorrection::GlobalCorrection(const SymmetricMatrix& matrix, const std::vector<int>& names,
                                   int num_nodes) {
  Interpolation total = make_interpolation(matrix);
  SymmetricMatrix coarse = coarse_matrix(matrix, total);
  while (coarse.size() > std::max<double>(kFewEnough, kSmallShare * matrix.size())) {
    const Interpolation next = make_interpolation(coarse);
    if (next.num_coarse > kLeastGain * coarse.size()) break;
    coarse = coarse_matrix(coarse, next);
    total = composed(total, next);
  }
  factor_ = SparseCholesky(coarse, minimum_degree_order(coarse));
  right_.setZero(3, coarse.size());
  solution_.setZero(3, coarse.size());
  coarse_.setZero(4, coarse.size());
  nodes_.setZero(4, num_nodes);
  std::vector<int> unknown_of(at(num_nodes), -1);
  for (int u = 0; u < static_cast<int>(names.size()); ++u) unknown_of[at(names[at(u)])] = u;
  using Row = std::vector<std::pair<int, float>>;
  std::vector<Row> of_coarse(at(coarse.size()));
  std::vector<Row> of_node(at(num_nodes));
  for (int node = 0; node < num_nodes; ++node) {
    const int u = unknown_of[at(node)];
    if (u < 0) continue;
    for (int e = total.starts[at(u)]; e < total.starts[at(u) + 1]; ++e) {
      const auto weight = static_cast<float>(total.values[at(e)]);
      of_node[at(node)].emplace_back(total.columns[at(e)], weight);
      of_coarse[at(total.columns[at(e)])].emplace_back(node, weight);
    }
  }
  refine_ = make_sums(of_node);
  coarsen_ = make_sums(of_coarse);
}

GlobalCorrection::Sums GlobalCorrection::make_sums(
    const std::vector<std::vector<std::pair<int, float>>>& rows) {
  Sums sums;
  for (const auto& row : rows)
    sums.num_terms = std::max(sums.num_terms, static_cast<int>(row.size()));
  for (const auto& row : rows) {
    for (int k = 0; k < sums.num_terms; ++k) {
      const bool is_filled = k < static_cast<int>(row.size());
      sums.columns.push_back(is_filled ? row[at(k)].first : 0);
      sums.weights.push_back(is_filled ? row[at(k)].second : 0.0F);
    }
  }
  return sums;
}

std::size_t GlobalCorrection::num_bytes() const {
  const std::size_t num_weights = coarsen_.weights.size() + refine_.weights.size();
  return factor_.num_bytes() + num_weights * (sizeof(int) + sizeof(float));
}

inline Eigen::Vector4f GlobalCorrection::sum_of(const Sums& sums, Eigen::Index row,
                                                const Fours& values) {
  const Eigen::Index first = row * sums.num_terms;
  const int* const columns = sums.columns.data() + first;
  const float* const weights = sums.weights.data() + first;
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int k = 0; k < sums.num_terms; ++k) sum += weights[k] * values.col(columns[k]);
  return sum;
}

// Four numbers for a node, of which the last is not used: what a processor loads and adds at once.
void GlobalCorrection::solve(const NodeArrays<float>& residual, NodeArrays<float>& correction) {
  const Eigen::Index n = residual.rows();
  const float* const from = residual.data();
  for (Eigen::Index i = 0; i < nodes_.cols(); ++i) {
    nodes_.col(i) << from[i], from[n + i], from[2 * n + i], 0.0F;
  }
  for (int c = 0; c < size(); ++c) right_.col(c) = sum_of(coarsen_, c, nodes_).head<3>();
  factor_.solve(right_, solution_);
  coarse_.topRows<3>() = solution_;
  float* const to = correction.data();
  for (Eigen::Index i = 0; i < nodes_.cols(); ++i) {
    const Eigen::Vector4f sum = sum_of(refine_, i, coarse_);
    to[i] = sum[0];
    to[n + i] = sum[1];
    to[2 * n + i] = sum[2];
  }
  correction.bottomRows(n - nodes_.cols()).setZero();
}

}  // namespace weft::fast
