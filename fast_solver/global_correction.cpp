#include <weft/fast_solver/global_correction.hpp>

#include <algorithm>
#include <utility>

#include <weft/fast_solver/correction_maker.hpp>
#include <weft/fast_solver/network_kernel.hpp>
#include <weft/fast_solver/node_arrays.hpp>

namespace weft::fast {
namespace {

/// Terms of a sum beyond so many times the mean stand apart.
constexpr std::size_t kLongSum = 3;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

GlobalCorrection::GlobalCorrection(const SymmetricMatrix& matrix, const std::vector<int>& names,
                                   int num_nodes) {
  CorrectionMaker maker(matrix, names, num_nodes);
  while (!maker.advance()) {
  }
  *this = maker.take();
}

void GlobalCorrection::add_copies(const std::vector<int>& origins) {
  int node = num_nodes_;
  const auto take_part = [&](int coarse, float weight) {
    if (weight != 0) coarsen_.rest.push_back({coarse, node, weight});
  };
  for (const int origin : origins) {
    for (int k = 0; k < refine_.num_terms; ++k) {
      const std::size_t term = at(origin * refine_.num_terms + k);
      const int coarse = refine_.columns[term];
      const float weight = refine_.weights[term];
      refine_.columns.push_back(coarse);
      refine_.weights.push_back(weight);
      take_part(coarse, weight);
    }
    for (std::size_t t = 0, end = refine_.rest.size(); t < end; ++t) {
      const Sums::Term term = refine_.rest[t];
      if (term.sum != origin) continue;
      refine_.rest.push_back({node, term.column, term.weight});
      take_part(term.column, term.weight);
    }
    ++node;
  }
  num_nodes_ = node;
  nodes_.setZero(4, fill_up(node));
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
  const auto num_sums = sums.num_terms > 0
                            ? static_cast<Eigen::Index>(sums.weights.size()) / sums.num_terms
                            : Eigen::Index{0};
  for (Eigen::Index row = 0; row < num_sums; ++row) {
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
  vector_kernel().to_fours(residual.data(), residual.rows(), nodes_.data());
  add_up(coarsen_, nodes_, coarse_sums_);
  right_ = coarse_sums_.topRows<3>();
  factor_.solve(right_, solution_);
  coarse_.topRows<3>() = solution_;
  add_up(refine_, coarse_, nodes_);
  vector_kernel().from_fours(nodes_.data(), correction.rows(), correction.data());
}

}  // namespace weft::fast
