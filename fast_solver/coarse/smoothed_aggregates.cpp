#include <weft/fast_solver/coarse/smoothed_aggregates.hpp>

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

#include <weft/fast_solver/coarse/interpolation.hpp>
#include <weft/fast_solver/network/sparse_matrix.hpp>

namespace weft::fast {
namespace {

/// The relaxation of Jacobi's method [-].
constexpr double kRelaxation = 2.0 / 3;
constexpr int kSweeps = kHatReach;
/// Between seeds, over that of springs and the root of a patch's unknowns: what gives about as many as are wanted on a grid.
constexpr double kMeanDistance = 0.6;
/// Distances are made so much longer than a smaller number of seeds asks for.
constexpr double kWider = 1.03;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// For each unknown: the nearest seed so far, along springs, and how far it is [m]; those that are farther than `most` have
/// none.
class NearestSeeds {
 public:
  NearestSeeds(const IsotropicNetwork& network, double most)
      : network_(&network),
        most_(most),
        nearest_(at(network.matrix.size()), -1),
        distances_(at(network.matrix.size()), std::numeric_limits<double>::infinity()) {}

  void add(int seed) {
    const SymmetricMatrix& matrix = network_->matrix;
    distances_[at(seed)] = 0;
    nearest_[at(seed)] = num_seeds_;
    ways_.emplace(0.0, seed);
    while (!ways_.empty()) {
      const auto [distance, i] = ways_.top();
      ways_.pop();
      if (distance > distances_[at(i)]) continue;
      for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
        const int j = matrix.columns[at(e)];
        const double way = distance + network_->lengths[at(e)];
        if (!(matrix.values[at(e)] < 0) || way >= std::min(most_, distances_[at(j)])) continue;
        distances_[at(j)] = way;
        nearest_[at(j)] = num_seeds_;
        ways_.emplace(way, j);
      }
    }
    ++num_seeds_;
  }
  [[nodiscard]] int num_seeds() const { return num_seeds_; }
  [[nodiscard]] double distance(int i) const { return distances_[at(i)]; }
  [[nodiscard]] const std::vector<int>& nearest() const { return nearest_; }

 private:
  using Way = std::pair<double, int>;
  const IsotropicNetwork* network_;
  double most_;
  std::vector<int> nearest_;
  std::vector<double> distances_;
  std::priority_queue<Way, std::vector<Way>, std::greater<>> ways_;
  int num_seeds_ = 0;
};

/// Unknowns with springs, corners and edges first: hats are flat behind their last seeds, a free edge is what swings
/// most, and round a corner that is held they are steep.
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

/// Seeds that are at least so far from each other, and from one of which every unknown is less far.
NearestSeeds seeds_at(double distance, const std::vector<int>& order,
                      const IsotropicNetwork& network) {
  NearestSeeds seeds(network, distance);
  for (const int i : order) {
    if (seeds.distance(i) >= distance) seeds.add(i);
  }
  return seeds;
}

/// By their first unknowns, so that those of unknowns in a row have numbers in a row.
Patches in_order(std::vector<int> patch_of, int num_patches) {
  std::vector<int> numbers(at(num_patches), -1);
  int count = 0;
  for (int& patch : patch_of) {
    if (patch < 0) continue;
    int& number = numbers[at(patch)];
    if (number < 0) number = count++;
    patch = number;
  }
  return {count, std::move(patch_of)};
}

/// Rows of weights: what an unknown has of each patch.
class Rows {
 public:
  using Entry = std::pair<int, double>;  ///< patch, weight

  [[nodiscard]] std::span<const Entry> operator[](int i) const {
    return std::span(entries_).subspan(starts_[at(i)], starts_[at(i) + 1] - starts_[at(i)]);
  }
  void add(int patch, double weight) { entries_.emplace_back(patch, weight); }
  void end_row() { starts_.push_back(entries_.size()); }
  void clear() {
    entries_.clear();
    starts_.resize(1);
  }

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> starts_ = {0};
};

/// Each free unknown of the first count becomes what its neighbours are, by their springs, for a part.
void smooth(const SymmetricMatrix& matrix, const std::vector<bool>& is_free, int count,
            const Rows& rows, RowSum& sum, Rows& result) {
  result.clear();
  for (int i = 0; i < count; ++i) {
    if (is_free[at(i)]) {
      for (const auto& [patch, weight] : rows[i]) sum.add(patch, (1 - kRelaxation) * weight);
      for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
        const double share = -kRelaxation * matrix.values[at(e)] / matrix.diagonal[at(i)];
        if (!(share > 0)) continue;
        for (const auto& [patch, weight] : rows[matrix.columns[at(e)]]) {
          sum.add(patch, share * weight);
        }
      }
      sum.flush([&](int patch, double weight) { result.add(patch, weight); });
    }
    result.end_row();
  }
}

/// The largest weights of a row, scaled to the sum of all.
void keep_largest(std::vector<Rows::Entry>& row) {
  if (static_cast<int>(row.size()) <= kMostWeights) return;
  double all = 0;
  for (const auto& [patch, weight] : row) all += weight;
  std::stable_sort(row.begin(), row.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  row.resize(kMostWeights);
  double kept = 0;
  for (const auto& [patch, weight] : row) kept += weight;
  for (auto& [patch, weight] : row) weight *= all / kept;
  std::sort(row.begin(), row.end());
}

}  // namespace

Patches find_patches(const IsotropicNetwork& network, int num_patches) {
  const std::vector<int> order = corners_first(network.matrix);
  const double sum = std::accumulate(network.lengths.begin(), network.lengths.end(), 0.0);
  const double mean = sum / static_cast<double>(std::max<std::size_t>(1, network.lengths.size()));
  const double share = static_cast<double>(order.size()) / num_patches;
  double distance = share > 1 ? kMeanDistance * mean * std::sqrt(share) : 0.0;
  NearestSeeds seeds = seeds_at(distance, order, network);
  // No two seeds of a piece are farther from each other than all springs are long.
  for (int last = 0; seeds.num_seeds() > num_patches && distance < sum;) {
    // In a sheet. Many pieces have a seed each, whatever the distance.
    const double too_many = static_cast<double>(seeds.num_seeds()) / num_patches;
    distance = std::max(distance, mean / 2) * std::sqrt(too_many) *
               (seeds.num_seeds() == last ? 2.0 : kWider);
    last = seeds.num_seeds();
    seeds = seeds_at(distance, order, network);
  }
  return in_order(seeds.nearest(), seeds.num_seeds());
}

Interpolation smoothed_aggregates(const IsotropicNetwork& network, const std::vector<bool>& is_free,
                                  const Patches& patches) {
  return smoothed_aggregates(network, is_free, patches,
                             std::vector<int>(at(2 * kHatReach + 1), network.matrix.size()));
}

Interpolation smoothed_aggregates(const IsotropicNetwork& network, const std::vector<bool>& is_free,
                                  const Patches& patches, const std::vector<int>& ends_of_rings) {
  const SymmetricMatrix& matrix = network.matrix;
  Rows rows;
  Rows others;
  for (int i = 0; i < matrix.size(); ++i) {
    const int patch = patches.of_unknown[at(i)];
    if (is_free[at(i)] && patch >= 0) rows.add(patch, 1);
    rows.end_row();
  }
  RowSum sum(patches.count);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    smooth(matrix, is_free, ends_of_rings[at(2 * kHatReach - 1 - sweep)], rows, sum, others);
    std::swap(rows, others);
  }
  Interpolation result;
  result.num_coarse = patches.count;
  result.starts.push_back(0);
  std::vector<Rows::Entry> row;
  for (int i = 0; i < ends_of_rings[at(kHatReach)]; ++i) {
    row.assign(rows[i].begin(), rows[i].end());
    keep_largest(row);
    for (const auto& [patch, weight] : row) {
      result.columns.push_back(patch);
      result.values.push_back(weight);
    }
    result.starts.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

}  // namespace weft::fast
