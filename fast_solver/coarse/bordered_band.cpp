#include <weft/fast_solver/coarse/bordered_band.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

namespace weft::fast {
namespace {

/// A pivot below this share of the diagonal is rounding [-].
constexpr float kLeastPivot = 1e-6F;

using Neighbours = std::vector<std::vector<int>>;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int filled_up(int count) {
  return (count + kRowPad - 1) / kRowPad * kRowPad;
}

/// How many ends of a piece are looked at.
constexpr int kMostEnds = 8;

/// Walks from pair to pair. Takes time for what it reaches, not for all unknowns.
class Walk {
 public:
  explicit Walk(const Neighbours& neighbours)
      : neighbours_(&neighbours), distances_(neighbours.size(), -1) {}

  /// The flagged unknowns that pairs in a row lead to, the nearest ones first.
  const std::vector<int>& from(int first, const std::vector<char>& is_in) {
    for (const int i : reached_) distances_[at(i)] = -1;
    reached_ = {first};
    distances_[at(first)] = 0;
    for (std::size_t next = 0; next < reached_.size(); ++next) {
      const int i = reached_[next];
      for (const int j : (*neighbours_)[at(i)]) {
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
  const Neighbours* neighbours_;
  std::vector<int> distances_;
  std::vector<int> reached_;
};

/// An unknown of a piece, and how far the others are from it.
struct End {
  int unknown;
  std::vector<int> distances;  ///< of each of the piece, in its order
};

/// Ends of a piece that are far from each other.
std::vector<End> ends_of(const std::vector<int>& piece, Walk& walk,
                         const std::vector<char>& is_in) {
  std::vector<End> result;
  std::vector<int> nearest(piece.size(), std::numeric_limits<int>::max());
  int next = piece.back();  // in the order in which it was reached: an end
  while (std::ssize(result) < std::min<std::ptrdiff_t>(kMostEnds, std::ssize(piece))) {
    (void)walk.from(next, is_in);
    End& end = result.emplace_back(End{next, {}});
    for (std::size_t k = 0; k < piece.size(); ++k) {
      end.distances.push_back(walk.distance(piece[k]));
      nearest[k] = std::min(nearest[k], end.distances[k]);
    }
    next = piece[at(
        static_cast<int>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin()))];
  }
  return result;
}

/// How far apart neighbours are in an order at most, and one more. places: of all unknowns, -1, and so again.
int width_of(const std::vector<int>& order, const Neighbours& neighbours,
             std::vector<int>& places) {
  for (std::size_t k = 0; k < order.size(); ++k) places[at(order[k])] = static_cast<int>(k);
  int width = 1;
  for (const int i : order) {
    for (const int j : neighbours[at(i)]) {
      if (places[at(j)] >= 0) width = std::max(width, places[at(j)] - places[at(i)] + 1);
    }
  }
  for (const int i : order) places[at(i)] = -1;
  return width;
}

/// The flagged unknowns in an order in which neighbours are near each other (Cuthill and McKee 1969): piece after piece,
/// each from the one of its ends that makes it narrowest.
std::vector<int> narrow_order(const Neighbours& neighbours, std::vector<char> is_in, Walk& walk) {
  std::vector<int> result;
  std::vector<int> places(neighbours.size(), -1);
  for (int i = 0; i < static_cast<int>(is_in.size()); ++i) {
    if (is_in[at(i)] == 0) continue;
    const std::vector<int> piece = walk.from(i, is_in);
    std::vector<int> best;
    int least = std::numeric_limits<int>::max();
    for (const End& end : ends_of(piece, walk, is_in)) {
      const std::vector<int>& order = walk.from(end.unknown, is_in);
      const int width = width_of(order, neighbours, places);
      if (width >= least) continue;
      least = width;
      best = order;
    }
    for (const int unknown : best) is_in[at(unknown)] = 0;
    result.insert(result.end(), best.begin(), best.end());
  }
  return result;
}

/// A piece in two halves and what is between them.
struct Parted {
  std::vector<int> unknowns;
  std::vector<signed char> half;  ///< of each of them: 0 or 1; 2: between
  std::array<int, 3> sizes{};
};

/// Between: those of the first `count` of an order that have a neighbour behind them. is_before: of all unknowns, 0, and so
/// again.
Parted parted(const std::vector<int>& order, std::size_t count, const Neighbours& neighbours,
              std::vector<char>& is_before) {
  Parted result{order, {}};
  for (std::size_t k = 0; k < count; ++k) is_before[at(order[k])] = 1;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::vector<int>& list = neighbours[at(order[k])];
    const bool is_between = k < count && std::any_of(list.begin(), list.end(),
                                                     [&](int j) { return is_before[at(j)] == 0; });
    result.half.push_back(k >= count ? 1 : is_between ? 2 : 0);
    ++result.sizes[at(result.half.back())];
  }
  for (std::size_t k = 0; k < count; ++k) is_before[at(order[k])] = 0;
  return result;
}

/// Across the way from one of its ends to another one: those for which least is between, and the halves are alike.
Parted parted(const std::vector<int>& piece, const Neighbours& neighbours, Walk& walk,
              const std::vector<char>& is_in) {
  const std::vector<End> ends = ends_of(piece, walk, is_in);
  std::vector<char> is_before(neighbours.size(), 0);
  std::vector<std::size_t> sorted(piece.size());
  std::vector<int> order(piece.size());
  Parted best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < ends.size(); ++a) {
    for (std::size_t b = a + 1; b < ends.size(); ++b) {
      const auto way = [&](std::size_t k) { return ends[a].distances[k] - ends[b].distances[k]; };
      std::iota(sorted.begin(), sorted.end(), std::size_t{0});
      std::stable_sort(sorted.begin(), sorted.end(),
                       [&](std::size_t k, std::size_t l) { return way(k) < way(l); });
      for (std::size_t k = 0; k < sorted.size(); ++k) order[k] = piece[sorted[k]];
      Parted one = parted(order, order.size() / 2, neighbours, is_before);
      one = parted(order, (order.size() + at(one.sizes[2])) / 2, neighbours, is_before);
      const double between = one.sizes[2];
      const double cost = between * between * (std::max(one.sizes[0], one.sizes[1]) + between / 6);
      if (cost >= least) continue;
      least = cost;
      best = std::move(one);
    }
  }
  return best;
}

/// 0 or 1: the half of each unknown; 2: what is between them. Only a piece that is most of all is parted.
std::vector<signed char> halves_of(const Neighbours& neighbours, Walk& walk) {
  const auto n = static_cast<int>(neighbours.size());
  std::vector<signed char> half(at(n), -1);
  const std::vector<char> is_in(at(n), 1);
  std::array<int, 3> sizes{};
  for (int i = 0; i < n; ++i) {
    if (half[at(i)] >= 0) continue;
    const std::vector<int> piece = walk.from(i, is_in);
    if (2 * static_cast<int>(piece.size()) > n && piece.size() > 2) {
      const Parted halves = parted(piece, neighbours, walk, is_in);
      for (std::size_t k = 0; k < halves.half.size(); ++k) {
        half[at(halves.unknowns[k])] = halves.half[k];
        ++sizes[at(halves.half[k])];
      }
      continue;
    }
    const signed char smaller = sizes[1] < sizes[0] ? 1 : 0;
    for (const int unknown : piece) half[at(unknown)] = smaller;
    sizes[at(smaller)] += static_cast<int>(piece.size());
  }
  return half;
}

}  // namespace

BorderedBand::BorderedBand(int num_unknowns, const std::vector<std::pair<int, int>>& pairs)
    : places_(at(num_unknowns), 0), pairs_(pairs) {
  Neighbours neighbours(at(num_unknowns));
  pairs_of_.resize(at(num_unknowns));
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto& [a, b] = pairs[p];
    neighbours[at(a)].push_back(b);
    neighbours[at(b)].push_back(a);
    pairs_of_[at(a)].push_back(static_cast<int>(p));
    pairs_of_[at(b)].push_back(static_cast<int>(p));
  }
  for (auto& list : neighbours) std::sort(list.begin(), list.end());
  for (int i = 0; i < num_unknowns; ++i) {
    const auto first = std::lower_bound(pairs.begin(), pairs.end(), std::pair(i, 0));
    first_pairs_.push_back(static_cast<int>(first - pairs.begin()));
  }
  order(neighbours);
  const Band& last = bands_[kHalves];
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const int low = std::min(places_[at(pairs[p].first)], places_[at(pairs[p].second)]);
    const int high = std::max(places_[at(pairs[p].first)], places_[at(pairs[p].second)]);
    for (Band& band : bands_) {
      if (low < band.begin || low >= band.end) continue;
      band.pairs.push_back(static_cast<int>(p));
      if (high < band.end) band.width = std::max(band.width, high - low + 1);
    }
  }
  bands_[kHalves].width = std::max(1, last.size());
  num_border_ = filled_up(3 * last.size());
  for (int k = 0; k < kHalves; ++k) reserve(bands_[at(k)], num_border_);
  reserve(bands_[kHalves], 0);
}

void BorderedBand::order(const std::vector<std::vector<int>>& neighbours) {
  Walk walk(neighbours);
  const std::vector<signed char> half = halves_of(neighbours, walk);
  for (int k = 0; k <= kHalves; ++k) {
    Band& band = bands_[at(k)];
    std::vector<char> is_in(half.size());
    for (std::size_t i = 0; i < half.size(); ++i) is_in[i] = half[i] == k ? 1 : 0;
    band.begin = static_cast<int>(unknowns_.size());
    for (const int unknown : narrow_order(neighbours, is_in, walk)) unknowns_.push_back(unknown);
    band.end = static_cast<int>(unknowns_.size());
    if (band.size() == 0) continue;
    const auto [lowest, highest] =
        std::minmax_element(unknowns_.begin() + band.begin, unknowns_.begin() + band.end);
    band.lowest = *lowest;
    band.highest = *highest + 1;
  }
  for (std::size_t k = 0; k < unknowns_.size(); ++k)
    places_[at(unknowns_[k])] = static_cast<int>(k);
}

void BorderedBand::reserve(Band& band, int num_border) {
  const int num_near = filled_up(3 * band.width) + kRowPad;
  const auto size = static_cast<std::size_t>(band.size());
  band.values.assign(3 * size * static_cast<std::size_t>(num_near + num_border), 0.0F);
  band.diagonal.assign(6 * size, 0.0F);
  band.vector.assign(3 * size + static_cast<std::size_t>(num_near), 0.0F);
  band.border.assign(static_cast<std::size_t>(num_border), 0.0F);
  band.corner.assign(static_cast<std::size_t>(num_border) * static_cast<std::size_t>(num_border),
                     0.0F);
}

BandRows BorderedBand::rows_of(Band& band) const {
  const int num_near = filled_up(3 * band.width) + kRowPad;
  const int num_border = &band == &bands_[kHalves] ? 0 : num_border_;
  return {band.values.data(), band.diagonal.data(),  num_near,
          num_border,         num_near + num_border, band.width};
}

void BorderedBand::fill(Band& band, const float* blocks, const float* inertia) {
  const BandRows rows = rows_of(band);
  const Band& last = bands_[kHalves];
  const auto block_of = [&](int block) { return blocks + long{block} * kBlockNumbers; };
  static constexpr int kOf[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  const auto add = [&](int place, long column, const float* block, float sign) {
    float* const row = rows.values + 3L * (place - band.begin) * rows.stride + column;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) row[r * rows.stride + c] += sign * block[kOf[r][c]];
    }
  };
  std::fill(band.values.begin(), band.values.end(), 0.0F);
  for (int place = band.begin; place < band.end; ++place) {
    const int unknown = unknowns_[at(place)];
    add(place, 0, block_of(own_block(unknown)), 1);
    for (const int p : pairs_of_[at(unknown)]) add(place, 0, block_of(pair_block(p)), 1);
    float* const row = rows.values + 3L * (place - band.begin) * rows.stride;
    for (int r = 0; r < 3; ++r) row[r * rows.stride + r] += inertia[unknown];
  }
  for (const int p : band.pairs) {
    const int low = std::min(places_[at(pairs_[at(p)].first)], places_[at(pairs_[at(p)].second)]);
    const int high = std::max(places_[at(pairs_[at(p)].first)], places_[at(pairs_[at(p)].second)]);
    const bool is_near = high < band.end;
    add(low, is_near ? 3L * (high - low) : rows.num_near + 3L * (high - last.begin),
        block_of(pair_block(p)), -1);
  }
}

void BorderedBand::factorise(const float* blocks, const float* inertia, ThreadTeam& team) {
  const CoarseKernel& kernel = coarse_kernel();
  const auto set_scales = [&](Band& band) {
    const BandRows rows = rows_of(band);
    for (int i = 0; i < band.size(); ++i) {
      const float* const row = rows.values + 3L * i * rows.stride;
      rows.diagonal[6 * i] = row[0] + row[rows.stride + 1] + row[2 * rows.stride + 2];
    }
  };
  team.run(kHalves, [&](int half) {
    Band& band = bands_[at(half)];
    fill(band, blocks, inertia);
    set_scales(band);
    std::fill(band.corner.begin(), band.corner.end(), 0.0F);
    kernel.factorise(rows_of(band), band.size(), kLeastPivot, band.corner.data());
  });
  Band& last = bands_[kHalves];
  if (last.size() == 0) return;
  fill(last, blocks, inertia);
  set_scales(last);
  const BandRows rows = rows_of(last);
  const int n = 3 * last.size();
  for (int r = 0; r < n; ++r) {
    const int own = r / 3 * 3;
    float* const row = rows.values + long{r} * rows.stride - own;
    for (int c = own; c < n; ++c) {
      const auto place = at(std::min(r, c) * num_border_ + std::max(r, c));
      for (int half = 0; half < kHalves; ++half) row[c] += bands_[at(half)].corner[place];
    }
  }
  kernel.factorise(rows, last.size(), kLeastPivot, nullptr);
}

// Each half sums up its own unknowns: most of what it reads is what its thread has written.
void BorderedBand::load(Band& band, std::span<const Summand> right) const {
  // Behind the unknowns too: what is not a number must not get stuck there.
  std::fill(band.vector.begin(), band.vector.end(), 0.0F);
  for (const Summand& summand : right) {
    const int end = std::min(band.highest, summand.end);
    for (int unknown = std::max(band.lowest, summand.begin); unknown < end; ++unknown) {
      const int place = places_[at(unknown)] - band.begin;
      if (place < 0 || place >= band.size()) continue;
      const float* const from = summand.numbers + 4L * (unknown - summand.begin);
      for (int axis = 0; axis < 3; ++axis) band.vector[at(3 * place + axis)] += from[axis];
    }
  }
}

void BorderedBand::unload(const Band& band, float* solution) const {
  for (int i = 0; i < band.size(); ++i) {
    std::copy(band.vector.begin() + 3L * i, band.vector.begin() + 3L * i + 3,
              solution + 4L * unknowns_[at(band.begin + i)]);
  }
}

void BorderedBand::solve(std::span<const Summand> right, float* solution, ThreadTeam& team) {
  const CoarseKernel& kernel = coarse_kernel();
  team.run(kHalves, [this, &kernel, right](int half) {
    Band& band = bands_[at(half)];
    load(band, right);
    std::fill(band.border.begin(), band.border.end(), 0.0F);
    kernel.go_up(rows_of(band), band.size(), band.vector.data(), band.border.data());
  });
  Band& last = bands_[kHalves];
  load(last, right);
  for (int k = 0; k < 3 * last.size(); ++k) {
    for (int half = 0; half < kHalves; ++half) last.vector[at(k)] += bands_[at(half)].border[at(k)];
  }
  kernel.go_up(rows_of(last), last.size(), last.vector.data(), nullptr);
  kernel.go_down(rows_of(last), last.size(), last.vector.data(), nullptr);
  unload(last, solution);
  team.run(kHalves, [this, &kernel, &last, solution](int half) {
    Band& band = bands_[at(half)];
    std::copy(last.vector.begin(), last.vector.begin() + 3L * last.size(), band.border.begin());
    kernel.go_down(rows_of(band), band.size(), band.vector.data(), band.border.data());
    unload(band, solution);
  });
}

}  // namespace weft::fast
