#include <weft/fast_solver/coarse/smoothed_aggregation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <weft/core/index.hpp>
#include <weft/fast_solver/coarse/prolongation.hpp>
#include <weft/fast_solver/network/sparse_matrix.hpp>

namespace weft::fast {
namespace {

/// The relaxation of Jacobi's method [-].
constexpr double kRelaxation = 2.0 / 3;
constexpr int kSweeps = kBasisReach;
/// The distance of roots over the mean spring length times sqrt(unknowns per aggregate). It gives about the wanted number on a grid.
constexpr double kMeanDistance = 0.6;
/// Distances grow by this factor more than a smaller number of roots requires.
constexpr double kWider = 1.03;

/// For each unknown: the nearest root so far, along springs, and how far it is [m]; those that are farther than `most` have
/// none.
class NearestRoots {
 public:
  NearestRoots(const ConnectivityGraph& network, double most)
      : network_(&network),
        most_(most),
        nearest_(at(network.matrix.size()), -1),
        distances_(at(network.matrix.size()), std::numeric_limits<double>::infinity()) {}

  void add(int root) {
    const SymmetricMatrix& matrix = network_->matrix;
    distances_[at(root)] = 0;
    nearest_[at(root)] = num_roots_;
    queue_.emplace(0.0, root);
    while (!queue_.empty()) {
      const auto [distance, i] = queue_.top();
      queue_.pop();
      if (distance > distances_[at(i)]) continue;
      for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
        const int j = matrix.columns[at(e)];
        const double distance_there = distance + network_->lengths[at(e)];
        if (!(matrix.values[at(e)] < 0) || distance_there >= std::min(most_, distances_[at(j)]))
          continue;
        distances_[at(j)] = distance_there;
        nearest_[at(j)] = num_roots_;
        queue_.emplace(distance_there, j);
      }
    }
    ++num_roots_;
  }
  [[nodiscard]] int num_roots() const { return num_roots_; }
  [[nodiscard]] double distance(int i) const { return distances_[at(i)]; }
  [[nodiscard]] const std::vector<int>& nearest() const { return nearest_; }

 private:
  using QueueEntry = std::pair<double, int>;
  const ConnectivityGraph* network_;
  double most_;
  std::vector<int> nearest_;
  std::vector<double> distances_;
  std::priority_queue<QueueEntry, std::vector<QueueEntry>, std::greater<>> queue_;
  int num_roots_ = 0;
};

/// Unknowns with springs, corners and edges first: coarse basis functions are flat behind their last roots, a free edge is what swings
/// most, and around a corner that is held they are steep.
std::vector<int> corners_first(const SymmetricMatrix& matrix) {
  std::vector<int> order;
  for (int i = 0; i < matrix.size(); ++i) {
    if (matrix.diagonal[at(i)] > 0) order.push_back(i);
  }
  const auto num_springs = [&](int i) { return matrix.starts[at(i) + 1] - matrix.starts[at(i)]; };
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return num_springs(i) < num_springs(j); });
  return order;
}

/// Roots that are at least so far from each other, and from one of which every unknown is less far.
NearestRoots roots_at(double distance, const std::vector<int>& order,
                      const ConnectivityGraph& network) {
  NearestRoots roots(network, distance);
  for (const int i : order) {
    if (roots.distance(i) >= distance) roots.add(i);
  }
  return roots;
}

/// By their first unknowns, so that those of unknowns in a row have numbers in a row.
Aggregates in_order(std::vector<int> aggregate_of, int num_aggregates) {
  std::vector<int> numbers(at(num_aggregates), -1);
  int count = 0;
  for (int& aggregate : aggregate_of) {
    if (aggregate < 0) continue;
    int& number = numbers[at(aggregate)];
    if (number < 0) number = count++;
    aggregate = number;
  }
  return {count, std::move(aggregate_of)};
}

/// Sparse rows of weights: one weight per aggregate.
class Rows {
 public:
  using Entry = std::pair<int, double>;  ///< aggregate, weight

  [[nodiscard]] std::span<const Entry> operator[](int i) const {
    return std::span(entries_).subspan(starts_[at(i)], starts_[at(i) + 1] - starts_[at(i)]);
  }
  void add(int aggregate, double weight) { entries_.emplace_back(aggregate, weight); }
  void end_row() { starts_.push_back(entries_.size()); }
  void clear() {
    entries_.clear();
    starts_.resize(1);
  }

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> starts_ = {0};
};

/// One damped Jacobi sweep over the first count unknowns; unknowns that are not free get no weights.
void smooth(const SymmetricMatrix& matrix, const std::vector<bool>& is_free, int count,
            const Rows& rows, RowSum& sum, Rows& result) {
  result.clear();
  for (int i = 0; i < count; ++i) {
    if (is_free[at(i)]) {
      for (const auto& [aggregate, weight] : rows[i])
        sum.add(aggregate, (1 - kRelaxation) * weight);
      for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
        const double share = -kRelaxation * matrix.values[at(e)] / matrix.diagonal[at(i)];
        if (!(share > 0)) continue;
        for (const auto& [aggregate, weight] : rows[matrix.columns[at(e)]]) {
          sum.add(aggregate, share * weight);
        }
      }
      sum.flush([&](int aggregate, double weight) { result.add(aggregate, weight); });
    }
    result.end_row();
  }
}

/// The largest weights of a row, scaled to the sum of all.
void keep_largest(std::vector<Rows::Entry>& row) {
  if (static_cast<int>(row.size()) <= kMostWeights) return;
  double all = 0;
  for (const auto& [aggregate, weight] : row) all += weight;
  std::stable_sort(row.begin(), row.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  row.resize(kMostWeights);
  double kept = 0;
  for (const auto& [aggregate, weight] : row) kept += weight;
  for (auto& [aggregate, weight] : row) weight *= all / kept;
  std::sort(row.begin(), row.end());
}

}  // namespace

Aggregates find_aggregates(const ConnectivityGraph& network, int num_aggregates) {
  const std::vector<int> order = corners_first(network.matrix);
  const double sum = std::accumulate(network.lengths.begin(), network.lengths.end(), 0.0);
  const double mean = sum / static_cast<double>(std::max<std::size_t>(1, network.lengths.size()));
  const double share = static_cast<double>(order.size()) / num_aggregates;
  double distance = share > 1 ? kMeanDistance * mean * std::sqrt(share) : 0.0;
  NearestRoots roots = roots_at(distance, order, network);
  // No two roots of a component are farther from each other than all springs are long.
  for (int last = 0; roots.num_roots() > num_aggregates && distance < sum;) {
    // This holds for a sheet. Many components keep a root each, whatever the distance.
    const double too_many = static_cast<double>(roots.num_roots()) / num_aggregates;
    distance = std::max(distance, mean / 2) * std::sqrt(too_many) *
               (roots.num_roots() == last ? 2.0 : kWider);
    last = roots.num_roots();
    roots = roots_at(distance, order, network);
  }
  return in_order(roots.nearest(), roots.num_roots());
}

Prolongation smoothed_aggregation(const ConnectivityGraph& network,
                                  const std::vector<bool>& is_free, const Aggregates& aggregates) {
  return smoothed_aggregation(network, is_free, aggregates,
                              std::vector<int>(at(2 * kBasisReach + 1), network.matrix.size()));
}

Prolongation smoothed_aggregation(const ConnectivityGraph& network,
                                  const std::vector<bool>& is_free, const Aggregates& aggregates,
                                  const std::vector<int>& ends_of_rings) {
  const SymmetricMatrix& matrix = network.matrix;
  Rows rows;
  Rows others;
  for (int i = 0; i < matrix.size(); ++i) {
    const int aggregate = aggregates.of_unknown[at(i)];
    if (is_free[at(i)] && aggregate >= 0) rows.add(aggregate, 1);
    rows.end_row();
  }
  RowSum sum(aggregates.count);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    smooth(matrix, is_free, ends_of_rings[at(2 * kBasisReach - 1 - sweep)], rows, sum, others);
    std::swap(rows, others);
  }
  Prolongation result;
  result.num_coarse = aggregates.count;
  result.starts.push_back(0);
  std::vector<Rows::Entry> row;
  for (int i = 0; i < ends_of_rings[at(kBasisReach)]; ++i) {
    row.assign(rows[i].begin(), rows[i].end());
    keep_largest(row);
    for (const auto& [aggregate, weight] : row) {
      result.columns.push_back(aggregate);
      result.values.push_back(weight);
    }
    result.starts.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

}  // namespace weft::fast
