#include <weft/fast_solver/bordered_band.hpp>

#include <algorithm>
#include <cstddef>

namespace weft::fast {
namespace {

/// Of the diagonal: a pivot below is rounding.
constexpr float kLeastPivot = 1e-6F;

using Neighbours = std::vector<std::vector<int>>;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int filled_up(int count) {
  return (count + kRowPad - 1) / kRowPad * kRowPad;
}

/// Rings around a first unknown, among those that are flagged; each ring in the order in which it is reached.
std::vector<std::vector<int>> rings_around(int first, const Neighbours& neighbours,
                                           const std::vector<char>& is_in) {
  std::vector<char> is_reached(neighbours.size(), 0);
  std::vector<std::vector<int>> rings = {{first}};
  is_reached[at(first)] = 1;
  while (true) {
    std::vector<int> ring;
    for (const int i : rings.back()) {
      for (const int j : neighbours[at(i)]) {
        if (is_in[at(j)] == 0 || is_reached[at(j)] != 0) continue;
        is_reached[at(j)] = 1;
        ring.push_back(j);
      }
    }
    if (ring.empty()) return rings;
    rings.push_back(std::move(ring));
  }
}

/// From an end of a piece to the other one.
std::vector<std::vector<int>> rings_of_piece(int any, const Neighbours& neighbours,
                                             const std::vector<char>& is_in) {
  std::vector<std::vector<int>> rings = rings_around(any, neighbours, is_in);
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<std::vector<int>> others = rings_around(rings.back().front(), neighbours, is_in);
    if (others.size() <= rings.size()) break;
    rings = std::move(others);
  }
  return rings;
}

/// The flagged unknowns in an order in which neighbours are near each other (Cuthill and McKee 1969).
std::vector<int> narrow_order(const Neighbours& neighbours, std::vector<char> is_in) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(is_in.size()); ++i) {
    if (is_in[at(i)] == 0) continue;
    for (const std::vector<int>& ring : rings_of_piece(i, neighbours, is_in)) {
      for (const int j : ring) {
        result.push_back(j);
        is_in[at(j)] = 0;
      }
    }
  }
  return result;
}

/// 0 or 1: the half of each unknown; 2: the ring between them.
std::vector<signed char> halves_of(const Neighbours& neighbours) {
  const auto n = static_cast<int>(neighbours.size());
  std::vector<signed char> half(at(n), -1);
  std::vector<char> is_in(at(n), 1);
  std::array<int, 2> sizes = {0, 0};
  for (int i = 0; i < n; ++i) {
    if (half[at(i)] >= 0) continue;
    const std::vector<std::vector<int>> rings = rings_of_piece(i, neighbours, is_in);
    int num = 0;
    for (const auto& ring : rings) num += static_cast<int>(ring.size());
    const bool is_parted = 2 * num > n && rings.size() > 2;
    const int smaller = sizes[1] < sizes[0] ? 1 : 0;
    int before = 0;
    bool is_behind = false;
    for (std::size_t k = 0; k < rings.size(); ++k) {
      const int next = before + static_cast<int>(rings[k].size());
      const bool is_border = is_parted && !is_behind && k > 0 && 2 * next >= num;
      for (const int j : rings[k]) {
        const int number = is_border ? 2 : !is_parted ? smaller : is_behind ? 1 : 0;
        half[at(j)] = static_cast<signed char>(number);
        is_in[at(j)] = 0;
        if (!is_border) ++sizes[at(half[at(j)])];
      }
      is_behind = is_behind || is_border;
      before = next;
    }
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
  const std::vector<signed char> half = halves_of(neighbours);
  for (int k = 0; k <= kHalves; ++k) {
    Band& band = bands_[at(k)];
    std::vector<char> is_in(half.size());
    for (std::size_t i = 0; i < half.size(); ++i) is_in[i] = half[i] == k ? 1 : 0;
    band.begin = static_cast<int>(unknowns_.size());
    for (const int unknown : narrow_order(neighbours, is_in)) unknowns_.push_back(unknown);
    band.end = static_cast<int>(unknowns_.size());
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

void BorderedBand::solve(const float* right, float* solution, ThreadTeam& team) {
  const CoarseKernel& kernel = coarse_kernel();
  const auto load = [&](Band& band) {
    for (int i = 0; i < band.size(); ++i) {
      const float* const from = right + 4L * unknowns_[at(band.begin + i)];
      std::copy(from, from + 3, band.vector.begin() + 3L * i);
    }
    // What is not a number must not get stuck behind them.
    std::fill(band.vector.begin() + 3L * band.size(), band.vector.end(), 0.0F);
  };
  const auto unload = [&](const Band& band) {
    for (int i = 0; i < band.size(); ++i) {
      std::copy(band.vector.begin() + 3L * i, band.vector.begin() + 3L * i + 3,
                solution + 4L * unknowns_[at(band.begin + i)]);
    }
  };
  team.run(kHalves, [&](int half) {
    Band& band = bands_[at(half)];
    load(band);
    std::fill(band.border.begin(), band.border.end(), 0.0F);
    kernel.go_up(rows_of(band), band.size(), band.vector.data(), band.border.data());
  });
  Band& last = bands_[kHalves];
  load(last);
  for (int k = 0; k < 3 * last.size(); ++k) {
    for (int half = 0; half < kHalves; ++half) last.vector[at(k)] += bands_[at(half)].border[at(k)];
  }
  kernel.go_up(rows_of(last), last.size(), last.vector.data(), nullptr);
  kernel.go_down(rows_of(last), last.size(), last.vector.data(), nullptr);
  unload(last);
  team.run(kHalves, [&](int half) {
    Band& band = bands_[at(half)];
    std::copy(last.vector.begin(), last.vector.begin() + 3L * last.size(), band.border.begin());
    kernel.go_down(rows_of(band), band.size(), band.vector.data(), band.border.data());
    unload(band);
  });
}

}  // namespace weft::fast
