#include <weft/fast_solver/coarse/dissected_cholesky.hpp>

#include <weft/core/index.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

namespace weft::fast {
namespace {

/// A pivot below this share of the diagonal is rounding [-].
constexpr float kLeastPivot = 1e-6F;

using Neighbors = std::vector<std::vector<int>>;

int padded_to_rows(int count) {
  return (count + kRowPad - 1) / kRowPad * kRowPad;
}

/// The number of pseudo-peripheral unknowns of a component that are tried.
constexpr int kMostEnds = 8;

/// Breadth-first search over pairs. Its cost depends on what it reaches, not on the number of unknowns.
class BreadthFirstSearch {
 public:
  explicit BreadthFirstSearch(const Neighbors& neighbors)
      : neighbors_(&neighbors), distances_(neighbors.size(), -1) {}

  /// The flagged unknowns that pairs in a row lead to, the nearest ones first.
  const std::vector<int>& from(int first, const std::vector<char>& is_in) {
    for (const int i : reached_) distances_[at(i)] = -1;
    reached_ = {first};
    distances_[at(first)] = 0;
    for (std::size_t next = 0; next < reached_.size(); ++next) {
      const int i = reached_[next];
      for (const int j : (*neighbors_)[at(i)]) {
        if (is_in[at(j)] == 0 || distances_[at(j)] >= 0) continue;
        distances_[at(j)] = distances_[at(i)] + 1;
        reached_.push_back(j);
      }
    }
    return reached_;
  }
  /// Pairs in a row; -1: none lead there.
  [[nodiscard]] int distance(int i) const { return distances_[at(i)]; }

 private:
  const Neighbors* neighbors_;
  std::vector<int> distances_;
  std::vector<int> reached_;
};

/// A pseudo-peripheral unknown of a connected component, with the distance of every other one.
struct PeripheralUnknown {
  int unknown;
  std::vector<int> distances;  ///< for each unknown of the component, in its order
};

/// Unknowns of a connected component that are far from each other (farthest-point sampling).
std::vector<PeripheralUnknown> peripheral_unknowns(const std::vector<int>& component,
                                                   BreadthFirstSearch& search,
                                                   const std::vector<char>& is_in) {
  std::vector<PeripheralUnknown> result;
  std::vector<int> nearest(component.size(), std::numeric_limits<int>::max());
  int next = component.back();  // in the order in which it was reached: an end
  while (std::ssize(result) < std::min<std::ptrdiff_t>(kMostEnds, std::ssize(component))) {
    (void)search.from(next, is_in);
    PeripheralUnknown& end = result.emplace_back(PeripheralUnknown{next, {}});
    for (std::size_t k = 0; k < component.size(); ++k) {
      end.distances.push_back(search.distance(component[k]));
      nearest[k] = std::min(nearest[k], end.distances[k]);
    }
    next = component[at(
        static_cast<int>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin()))];
  }
  return result;
}

/// How far apart neighbors are in an order at most, and one more. positions: of all unknowns, -1, and so again.
int width_of(const std::vector<int>& order, const Neighbors& neighbors,
             std::vector<int>& positions) {
  for (std::size_t k = 0; k < order.size(); ++k) positions[at(order[k])] = static_cast<int>(k);
  int width = 1;
  for (const int i : order) {
    for (const int j : neighbors[at(i)]) {
      if (positions[at(j)] >= 0) width = std::max(width, positions[at(j)] - positions[at(i)] + 1);
    }
  }
  for (const int i : order) positions[at(i)] = -1;
  return width;
}

/// Cuthill and McKee's order (1969) of the flagged unknowns, which has a small bandwidth: component after component,
/// each from the one of its ends that makes it narrowest.
std::vector<int> narrow_order(const Neighbors& neighbors, std::vector<char> is_in,
                              BreadthFirstSearch& search) {
  std::vector<int> result;
  std::vector<int> positions(neighbors.size(), -1);
  for (int i = 0; i < static_cast<int>(is_in.size()); ++i) {
    if (is_in[at(i)] == 0) continue;
    const std::vector<int> component = search.from(i, is_in);
    std::vector<int> best;
    int least = std::numeric_limits<int>::max();
    for (const PeripheralUnknown& end : peripheral_unknowns(component, search, is_in)) {
      const std::vector<int>& order = search.from(end.unknown, is_in);
      const int width = width_of(order, neighbors, positions);
      if (width >= least) continue;
      least = width;
      best = order;
    }
    for (const int unknown : best) is_in[at(unknown)] = 0;
    result.insert(result.end(), best.begin(), best.end());
  }
  return result;
}

/// A connected component split into two subdomains and a separator.
struct Dissection {
  std::vector<int> unknowns;
  std::vector<signed char> side;  ///< for each of them: 0 or 1; 2: between
  std::array<int, 3> sizes{};
};

/// Between: those of the first `count` of an order that have a neighbor behind them. is_before: of all unknowns, 0, and so
/// again.
Dissection dissect(const std::vector<int>& order, std::size_t count, const Neighbors& neighbors,
                   std::vector<char>& is_before) {
  Dissection result{order, {}};
  for (std::size_t k = 0; k < count; ++k) is_before[at(order[k])] = 1;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::vector<int>& list = neighbors[at(order[k])];
    const bool is_between = k < count && std::any_of(list.begin(), list.end(),
                                                     [&](int j) { return is_before[at(j)] == 0; });
    result.side.push_back(k >= count ? 1 : is_between ? 2 : 0);
    ++result.sizes[at(result.side.back())];
  }
  for (std::size_t k = 0; k < count; ++k) is_before[at(order[k])] = 0;
  return result;
}

/// Cuts between two pseudo-peripheral unknowns. The pair with a small separator and balanced subdomains is chosen.
Dissection dissect(const std::vector<int>& component, const Neighbors& neighbors,
                   BreadthFirstSearch& search, const std::vector<char>& is_in) {
  const std::vector<PeripheralUnknown> ends = peripheral_unknowns(component, search, is_in);
  std::vector<char> is_before(neighbors.size(), 0);
  std::vector<std::size_t> sorted(component.size());
  std::vector<int> order(component.size());
  Dissection best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < ends.size(); ++a) {
    for (std::size_t b = a + 1; b < ends.size(); ++b) {
      const auto way = [&](std::size_t k) { return ends[a].distances[k] - ends[b].distances[k]; };
      std::iota(sorted.begin(), sorted.end(), std::size_t{0});
      std::stable_sort(sorted.begin(), sorted.end(),
                       [&](std::size_t k, std::size_t l) { return way(k) < way(l); });
      for (std::size_t k = 0; k < sorted.size(); ++k) order[k] = component[sorted[k]];
      Dissection one = dissect(order, order.size() / 2, neighbors, is_before);
      one = dissect(order, (order.size() + at(one.sizes[2])) / 2, neighbors, is_before);
      const double between = one.sizes[2];
      const double cost = between * between * (std::max(one.sizes[0], one.sizes[1]) + between / 6);
      if (cost >= least) continue;
      least = cost;
      best = std::move(one);
    }
  }
  return best;
}

/// The subdomain of each unknown, 0 or 1; 2 is the separator. Only a component with more than half of all unknowns is split;
/// smaller ones go to the subdomain that has fewer unknowns.
std::vector<signed char> sides_of(const Neighbors& neighbors, BreadthFirstSearch& search) {
  const auto n = static_cast<int>(neighbors.size());
  std::vector<signed char> side(at(n), -1);
  const std::vector<char> is_in(at(n), 1);
  std::array<int, 3> sizes{};
  for (int i = 0; i < n; ++i) {
    if (side[at(i)] >= 0) continue;
    const std::vector<int> component = search.from(i, is_in);
    if (2 * static_cast<int>(component.size()) > n && component.size() > 2) {
      const Dissection dissection = dissect(component, neighbors, search, is_in);
      for (std::size_t k = 0; k < dissection.side.size(); ++k) {
        side[at(dissection.unknowns[k])] = dissection.side[k];
        ++sizes[at(dissection.side[k])];
      }
      continue;
    }
    const signed char smaller = sizes[1] < sizes[0] ? 1 : 0;
    for (const int unknown : component) side[at(unknown)] = smaller;
    sizes[at(smaller)] += static_cast<int>(component.size());
  }
  return side;
}

}  // namespace

DissectedCholesky::DissectedCholesky(int num_unknowns,
                                     const std::vector<std::pair<int, int>>& pairs)
    : positions_(at(num_unknowns), 0), pairs_(pairs) {
  Neighbors neighbors(at(num_unknowns));
  pairs_of_.resize(at(num_unknowns));
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto& [a, b] = pairs[p];
    neighbors[at(a)].push_back(b);
    neighbors[at(b)].push_back(a);
    pairs_of_[at(a)].push_back(static_cast<int>(p));
    pairs_of_[at(b)].push_back(static_cast<int>(p));
  }
  for (auto& list : neighbors) std::sort(list.begin(), list.end());
  for (int i = 0; i < num_unknowns; ++i) {
    const auto first = std::lower_bound(pairs.begin(), pairs.end(), std::pair(i, 0));
    first_pairs_.push_back(static_cast<int>(first - pairs.begin()));
  }
  order(neighbors);
  const Subdomain& last = subdomains_[kSubdomains];
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const int low = std::min(positions_[at(pairs[p].first)], positions_[at(pairs[p].second)]);
    const int high = std::max(positions_[at(pairs[p].first)], positions_[at(pairs[p].second)]);
    for (Subdomain& subdomain : subdomains_) {
      if (low < subdomain.begin || low >= subdomain.end) continue;
      subdomain.pairs.push_back(static_cast<int>(p));
      if (high < subdomain.end) subdomain.width = std::max(subdomain.width, high - low + 1);
    }
  }
  subdomains_[kSubdomains].width = std::max(1, last.size());
  num_separator_ = padded_to_rows(3 * last.size());
  for (int k = 0; k < kSubdomains; ++k) reserve(subdomains_[at(k)], num_separator_);
  reserve(subdomains_[kSubdomains], 0);
}

void DissectedCholesky::order(const std::vector<std::vector<int>>& neighbors) {
  BreadthFirstSearch search(neighbors);
  const std::vector<signed char> side = sides_of(neighbors, search);
  for (int k = 0; k <= kSubdomains; ++k) {
    Subdomain& subdomain = subdomains_[at(k)];
    std::vector<char> is_in(side.size());
    for (std::size_t i = 0; i < side.size(); ++i) is_in[i] = side[i] == k ? 1 : 0;
    subdomain.begin = static_cast<int>(unknowns_.size());
    for (const int unknown : narrow_order(neighbors, is_in, search)) unknowns_.push_back(unknown);
    subdomain.end = static_cast<int>(unknowns_.size());
    if (subdomain.size() == 0) continue;
    const auto [lowest, highest] =
        std::minmax_element(unknowns_.begin() + subdomain.begin, unknowns_.begin() + subdomain.end);
    subdomain.lowest = *lowest;
    subdomain.highest = *highest + 1;
  }
  for (std::size_t k = 0; k < unknowns_.size(); ++k)
    positions_[at(unknowns_[k])] = static_cast<int>(k);
}

void DissectedCholesky::reserve(Subdomain& subdomain, int num_separator) {
  const int num_near = padded_to_rows(3 * subdomain.width) + kRowPad;
  const auto size = static_cast<std::size_t>(subdomain.size());
  subdomain.values.assign(3 * size * static_cast<std::size_t>(num_near + num_separator), 0.0F);
  subdomain.diagonal.assign(6 * size, 0.0F);
  subdomain.vector.assign(3 * size + static_cast<std::size_t>(num_near), 0.0F);
  subdomain.separator.assign(static_cast<std::size_t>(num_separator), 0.0F);
  subdomain.schur_complement.assign(
      static_cast<std::size_t>(num_separator) * static_cast<std::size_t>(num_separator), 0.0F);
}

FactorRows DissectedCholesky::rows_of(Subdomain& subdomain) const {
  const int num_near = padded_to_rows(3 * subdomain.width) + kRowPad;
  const int num_separator = &subdomain == &subdomains_[kSubdomains] ? 0 : num_separator_;
  return {subdomain.values.data(), subdomain.diagonal.data(), num_near,
          num_separator,           num_near + num_separator,  subdomain.width};
}

void DissectedCholesky::fill(Subdomain& subdomain, const float* blocks, const float* inertia) {
  const FactorRows rows = rows_of(subdomain);
  const Subdomain& last = subdomains_[kSubdomains];
  const auto block_of = [&](int block) { return blocks + long{block} * kBlockNumbers; };
  static constexpr int kOf[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  const auto add = [&](int position, long column, const float* block, float sign) {
    float* const row = rows.values + 3L * (position - subdomain.begin) * rows.stride + column;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) row[r * rows.stride + c] += sign * block[kOf[r][c]];
    }
  };
  std::fill(subdomain.values.begin(), subdomain.values.end(), 0.0F);
  for (int position = subdomain.begin; position < subdomain.end; ++position) {
    const int unknown = unknowns_[at(position)];
    add(position, 0, block_of(own_block(unknown)), 1);
    for (const int p : pairs_of_[at(unknown)]) add(position, 0, block_of(pair_block(p)), 1);
    float* const row = rows.values + 3L * (position - subdomain.begin) * rows.stride;
    for (int r = 0; r < 3; ++r) row[r * rows.stride + r] += inertia[unknown];
  }
  for (const int p : subdomain.pairs) {
    const int low =
        std::min(positions_[at(pairs_[at(p)].first)], positions_[at(pairs_[at(p)].second)]);
    const int high =
        std::max(positions_[at(pairs_[at(p)].first)], positions_[at(pairs_[at(p)].second)]);
    const bool is_near = high < subdomain.end;
    add(low, is_near ? 3L * (high - low) : rows.num_near + 3L * (high - last.begin),
        block_of(pair_block(p)), -1);
  }
}

void DissectedCholesky::factorize(const float* blocks, const float* inertia, WorkerTeam& team) {
  const CoarseKernel& kernel = coarse_kernel();
  const auto set_scales = [&](Subdomain& subdomain) {
    const FactorRows rows = rows_of(subdomain);
    for (int i = 0; i < subdomain.size(); ++i) {
      const float* const row = rows.values + 3L * i * rows.stride;
      rows.diagonal[6 * i] = row[0] + row[rows.stride + 1] + row[2 * rows.stride + 2];
    }
  };
  team.run(kSubdomains, [&](int side) {
    Subdomain& subdomain = subdomains_[at(side)];
    fill(subdomain, blocks, inertia);
    set_scales(subdomain);
    std::fill(subdomain.schur_complement.begin(), subdomain.schur_complement.end(), 0.0F);
    kernel.factorize(rows_of(subdomain), subdomain.size(), kLeastPivot,
                     subdomain.schur_complement.data());
  });
  Subdomain& last = subdomains_[kSubdomains];
  if (last.size() == 0) return;
  fill(last, blocks, inertia);
  set_scales(last);
  const FactorRows rows = rows_of(last);
  const int n = 3 * last.size();
  for (int r = 0; r < n; ++r) {
    const int own = r / 3 * 3;
    float* const row = rows.values + long{r} * rows.stride - own;
    for (int c = own; c < n; ++c) {
      const auto position = at(std::min(r, c) * num_separator_ + std::max(r, c));
      for (int side = 0; side < kSubdomains; ++side)
        row[c] += subdomains_[at(side)].schur_complement[position];
    }
  }
  kernel.factorize(rows, last.size(), kLeastPivot, nullptr);
}

// Each subdomain gathers its own right-hand side, because its thread has most of that data in its cache.
void DissectedCholesky::gather(Subdomain& subdomain, std::span<const Summand> right) const {
  // Behind the unknowns too: what is not a number must not get stuck there.
  std::fill(subdomain.vector.begin(), subdomain.vector.end(), 0.0F);
  for (const Summand& summand : right) {
    const int end = std::min(subdomain.highest, summand.end);
    for (int unknown = std::max(subdomain.lowest, summand.begin); unknown < end; ++unknown) {
      const int position = positions_[at(unknown)] - subdomain.begin;
      if (position < 0 || position >= subdomain.size()) continue;
      const float* const from = summand.numbers + 4L * (unknown - summand.begin);
      for (int axis = 0; axis < 3; ++axis) subdomain.vector[at(3 * position + axis)] += from[axis];
    }
  }
}

void DissectedCholesky::scatter(const Subdomain& subdomain, float* solution) const {
  for (int i = 0; i < subdomain.size(); ++i) {
    std::copy(subdomain.vector.begin() + 3L * i, subdomain.vector.begin() + 3L * i + 3,
              solution + 4L * unknowns_[at(subdomain.begin + i)]);
  }
}

void DissectedCholesky::solve(std::span<const Summand> right, float* solution, WorkerTeam& team) {
  const CoarseKernel& kernel = coarse_kernel();
  team.run(kSubdomains, [this, &kernel, right](int side) {
    Subdomain& subdomain = subdomains_[at(side)];
    gather(subdomain, right);
    std::fill(subdomain.separator.begin(), subdomain.separator.end(), 0.0F);
    kernel.forward_substitute(rows_of(subdomain), subdomain.size(), subdomain.vector.data(),
                              subdomain.separator.data());
  });
  Subdomain& last = subdomains_[kSubdomains];
  gather(last, right);
  for (int k = 0; k < 3 * last.size(); ++k) {
    for (int side = 0; side < kSubdomains; ++side)
      last.vector[at(k)] += subdomains_[at(side)].separator[at(k)];
  }
  kernel.forward_substitute(rows_of(last), last.size(), last.vector.data(), nullptr);
  kernel.backward_substitute(rows_of(last), last.size(), last.vector.data(), nullptr);
  scatter(last, solution);
  team.run(kSubdomains, [this, &kernel, &last, solution](int side) {
    Subdomain& subdomain = subdomains_[at(side)];
    std::copy(last.vector.begin(), last.vector.begin() + 3L * last.size(),
              subdomain.separator.begin());
    kernel.backward_substitute(rows_of(subdomain), subdomain.size(), subdomain.vector.data(),
                               subdomain.separator.data());
    scatter(subdomain, solution);
  });
}

}  // namespace weft::fast
