#include <weft/fast_solver/global_correction.hpp>

#include <utility>

#include <weft/fast_solver/minimum_degree.hpp>

namespace weft::fast {
namespace {

/// Coarse unknowns up to which no coarser ones are looked for: their factor is read in some 20 us.
constexpr int kFewEnough = 8000;
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
  while (coarse.size() > kFewEnough) {
    const Interpolation next = make_interpolation(coarse);
    if (next.num_coarse > kLeastGain * coarse.size()) break;
    coarse = coarse_matrix(coarse, next);
    total = composed(total, next);
  }
  factor_ = SparseCholesky(coarse, minimum_degree_order(coarse));
  right_.setZero(3, coarse.size());
  solution_.setZero(3, coarse.size());
  std::vector<int> unknown_of(at(num_nodes), -1);
  for (int u = 0; u < static_cast<int>(names.size()); ++u) unknown_of[at(names[at(u)])] = u;
  std::vector<std::vector<std::pair<int, float>>> parts(at(coarse.size()));
  refine_.starts.push_back(0);
  for (int node = 0; node < num_nodes; ++node) {
    const int u = unknown_of[at(node)];
    for (int e = u < 0 ? 0 : total.starts[at(u)]; u >= 0 && e < total.starts[at(u) + 1]; ++e) {
      const auto weight = static_cast<float>(total.values[at(e)]);
      refine_.columns.push_back(total.columns[at(e)]);
      refine_.values.push_back(weight);
      parts[at(total.columns[at(e)])].emplace_back(node, weight);
    }
    refine_.starts.push_back(static_cast<int>(refine_.columns.size()));
  }
  coarsen_.starts.push_back(0);
  for (const auto& row : parts) {
    for (const auto& [node, weight] : row) {
      coarsen_.columns.push_back(node);
      coarsen_.values.push_back(weight);
    }
    coarsen_.starts.push_back(static_cast<int>(coarsen_.columns.size()));
  }
}

std::size_t GlobalCorrection::num_bytes() const {
  const std::size_t num_weights = coarsen_.values.size() + refine_.values.size();
  return factor_.num_bytes() + num_weights * (sizeof(int) + sizeof(float));
}

void GlobalCorrection::solve(const NodeArrays<float>& residual, NodeArrays<float>& correction) {
  const float* const r = residual.data();
  const Eigen::Index n = residual.rows();
  for (int c = 0; c < size(); ++c) {
    float x = 0;
    float y = 0;
    float z = 0;
    for (int e = coarsen_.starts[at(c)]; e < coarsen_.starts[at(c) + 1]; ++e) {
      const float* const v = r + coarsen_.columns[at(e)];
      const float w = coarsen_.values[at(e)];
      x += w * v[0];
      y += w * v[n];
      z += w * v[2 * n];
    }
    right_.col(c) << x, y, z;
  }
  factor_.solve(right_, solution_);
  float* const result = correction.data();
  const auto num_nodes = static_cast<int>(refine_.starts.size()) - 1;
  for (int i = 0; i < num_nodes; ++i) {
    float x = 0;
    float y = 0;
    float z = 0;
    for (int e = refine_.starts[at(i)]; e < refine_.starts[at(i) + 1]; ++e) {
      const float* const v =
          solution_.data() + 3 * static_cast<Eigen::Index>(refine_.columns[at(e)]);
      const float w = refine_.values[at(e)];
      x += w * v[0];
      y += w * v[1];
      z += w * v[2];
    }
    result[i] = x;
    result[n + i] = y;
    result[2 * n + i] = z;
  }
  correction.bottomRows(n - num_nodes).setZero();
}

}  // namespace weft::fast
