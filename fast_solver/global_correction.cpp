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
/// Terms of a sum beyond so many times the mean stand apart.
constexpr std::size_t kLongSum = 3;

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
  coarse_sums_.setZero(4, coarse.size());
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
  std::size_t longest = 0;
  std::size_t all = 0;
  for (const auto& row : rows) {
    longest = std::max(longest, row.size());
    all += row.size();
  }
  const std::size_t common = kLongSum * all / std::max<std::size_t>(rows.size(), 1) + 1;
  sums.num_terms = static_cast<int>(std::min(longest, common));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto& row = rows[r];
    for (std::size_t k = 0; k < std::max(row.size(), at(sums.num_terms)); ++k) {
      const auto [column, weight] = k < row.size() ? row[k] : std::pair{0, 0.0F};
      if (k >= at(sums.num_terms)) {
        sums.rest.push_back({static_cast<int>(r), column, weight});
        continue;
      }
      sums.columns.push_back(column);
      sums.weights.push_back(weight);
    }
  }
  return sums;
}

std::size_t GlobalCorrection::num_bytes() const {
  const std::size_t num_weights = coarsen_.weights.size() + refine_.weights.size();
  return factor_.num_bytes() + num_weights * (sizeof(int) + sizeof(float));
}

void GlobalCorrection::add_up(const Sums& sums, const Fours& values, Fours& results) {
  const int* columns = sums.columns.data();
  const float* weights = sums.weights.data();
  for (Eigen::Index row = 0; row < results.cols(); ++row) {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    for (int k = 0; k < sums.num_terms; ++k) sum += *weights++ * values.col(*columns++);
    results.col(row) = sum;
  }
  for (const Sums::Term& term : sums.rest) {
    results.col(term.sum) += term.weight * values.col(term.column);
  }
}

// Four numbers for a node, of which the last is not used: what a processor loads and adds at once.
void GlobalCorrection::solve(const NodeArrays<float>& residual, NodeArrays<float>& correction) {
  const Eigen::Index n = residual.rows();
  const float* const from = residual.data();
  for (Eigen::Index i = 0; i < nodes_.cols(); ++i) {
    nodes_.col(i) << from[i], from[n + i], from[2 * n + i], 0.0F;
  }
  add_up(coarsen_, nodes_, coarse_sums_);
  right_ = coarse_sums_.topRows<3>();
  factor_.solve(right_, solution_);
  coarse_.topRows<3>() = solution_;
  add_up(refine_, coarse_, nodes_);
  float* const to = correction.data();
  for (Eigen::Index i = 0; i < nodes_.cols(); ++i) {
    to[i] = nodes_(0, i);
    to[n + i] = nodes_(1, i);
    to[2 * n + i] = nodes_(2, i);
  }
  correction.bottomRows(n - nodes_.cols()).setZero();
}

}  // namespace weft::fast
