#include <weft/fast_solver/smoothed_aggregates.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include <weft/fast_solver/interpolation.hpp>
#include <weft/fast_solver/sparse_matrix.hpp>

namespace weft::fast {
namespace {

/// Of Jacobi's method.
constexpr double kRelaxation = 2.0 / 3;
constexpr int kSweeps = 4;
/// Between seeds, over that of springs and the root of a patch's unknowns: what gives about as many as are wanted on a grid.
constexpr double kMeanDistance = 0.6;
/// Distances are made so much longer than a smaller number of seeds asks for.
constexpr double kWider = 1.03;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Of each unknown: the nearest seed so far, along springs, and how far it is [m].
class NearestSeeds {
 public:
  explicit NearestSeeds(const IsotropicNetwork& network)
      : network_(&network),
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
        if (!(matrix.values[at(e)] < 0) || way >= distances_[at(j)]) continue;
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
  std::vector<int> nearest_;
  std::vector<double> distances_;
  std::priority_queue<Way, std::vector<Way>, std::greater<>> ways_;
  int num_seeds_ = 0;
};

/// Corners and edges first: hats are flat behind their last seeds, and a free edge is what swings most.
std::vector<int> corners_first(const SymmetricMatrix& matrix) {
  std::vector<int> order(at(matrix.size()));
  std::iota(order.begin(), order.end(), 0);
  const auto num_springs = [&](int i) { return matrix.starts[at(i) + 1] - matrix.starts[at(i)]; };
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return num_springs(i) < num_springs(j); });
  return order;
}

/// Seeds that are at least so far from each other, and from one of which every unknown is less far.
NearestSeeds seeds_at(double distance, const std::vector<int>& order,
                      const IsotropicNetwork& network) {
  NearestSeeds seeds(network);
  for (const int i : order) {
    if (seeds.distance(i) >= distance) seeds.add(i);
  }
  return seeds;
}

/// The seeds of at most num_coarse patches, or one in each piece of the network.
NearestSeeds choose_seeds(const IsotropicNetwork& network, int num_coarse) {
  const std::vector<int> order = corners_first(network.matrix);
  const double sum = std::accumulate(network.lengths.begin(), network.lengths.end(), 0.0);
  const double mean = sum / static_cast<double>(std::max<std::size_t>(1, network.lengths.size()));
  const double share = static_cast<double>(network.matrix.size()) / num_coarse;
  double distance = share > 1 ? kMeanDistance * mean * std::sqrt(share) : 0.0;
  for (int last = 0;;) {
    NearestSeeds seeds = seeds_at(distance, order, network);
    // No two seeds of a piece are farther from each other than all springs are long.
    if (seeds.num_seeds() <= num_coarse || distance >= sum) return seeds;
    // In a sheet. Many pieces have a seed each, whatever the distance.
    const double too_many = static_cast<double>(seeds.num_seeds()) / num_coarse;
    distance = std::max(distance, mean / 2) * std::sqrt(too_many) *
               (seeds.num_seeds() == last ? 2.0 : kWider);
    last = seeds.num_seeds();
  }
}

using Row = std::vector<std::pair<int, double>>;  // of coarse unknowns, ascending

/// Each unknown becomes what its neighbours are, by their springs, for a part.
std::vector<Row> smoothed(const SymmetricMatrix& matrix, const std::vector<Row>& rows,
                          RowSum& sum) {
  std::vector<Row> result(rows.size());
  for (int i = 0; i < matrix.size(); ++i) {
    for (const auto& [column, weight] : rows[at(i)]) sum.add(column, (1 - kRelaxation) * weight);
    for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
      const double share = -kRelaxation * matrix.values[at(e)] / matrix.diagonal[at(i)];
      if (!(share > 0)) continue;
      for (const auto& [column, weight] : rows[at(matrix.columns[at(e)])]) {
        sum.add(column, share * weight);
      }
    }
    sum.flush([&](int column, double value) { result[at(i)].emplace_back(column, value); });
  }
  return result;
}

/// The largest weights of a row, scaled to the sum of all.
void keep_largest(Row& row) {
  if (static_cast<int>(row.size()) <= kMostWeights) return;
  double all = 0;
  for (const auto& [column, weight] : row) all += weight;
  std::stable_sort(row.begin(), row.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  row.resize(kMostWeights);
  double kept = 0;
  for (const auto& [column, weight] : row) kept += weight;
  for (auto& [column, weight] : row) weight *= all / kept;
  std::sort(row.begin(), row.end());
}

}  // namespace

Interpolation smoothed_aggregates(const IsotropicNetwork& network, int num_coarse) {
  const SymmetricMatrix& matrix = network.matrix;
  const NearestSeeds seeds = choose_seeds(network, num_coarse);
  Interpolation result;
  std::vector<Row> rows(at(matrix.size()));
  for (int i = 0; i < matrix.size(); ++i) rows[at(i)] = {{seeds.nearest()[at(i)], 1.0}};
  RowSum sum(seeds.num_seeds());
  for (int sweep = 0; sweep < kSweeps; ++sweep) rows = smoothed(matrix, rows, sum);
  result.starts.push_back(0);
  std::vector<int> number_of(at(seeds.num_seeds()), -1);  // hats that nobody keeps are none
  for (int i = 0; i < matrix.size(); ++i) {
    Row& row = rows[at(i)];
    if (!(matrix.diagonal[at(i)] > 0)) row.clear();  // the smoother is exact there
    keep_largest(row);
    for (const auto& [column, weight] : row) {
      int& number = number_of[at(column)];
      if (number < 0) number = result.num_coarse++;
      result.columns.push_back(number);
      result.values.push_back(weight);
    }
    result.starts.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

}  // namespace weft::fast
