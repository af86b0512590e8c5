#include <weft/fast_solver/network/edge_slots.hpp>

#include <weft/core/index.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace weft::fast {
namespace {

/// Neighbors at the same distance from which on a slot of their own is faster than fetching them one
/// by one.
constexpr int kFewestInARow = 4;

void open_slot(int first, const EdgeSlot& slot, EdgeSlots& slots) {
  slots.slots.push_back(slot);
  for (int lane = 0; lane < kNodeBlock; ++lane) {
    slots.others.push_back(std::min(first + lane, slots.num_nodes - 1));
    slots.edges.push_back(-1);
  }
}

void fill(int slot, const EdgeLane& lane, EdgeSlots& slots) {
  const std::size_t place = at(slot * kNodeBlock + lane.node % kNodeBlock);
  slots.others[place] = lane.other;
  slots.edges[place] = lane.edge;
}

}  // namespace

SlotMaker::Row& SlotMaker::row_at(int offset) {
  const auto is_it = [&](const Row& row) { return row.offset == offset; };
  if (next_row_ < rows_.size() && is_it(rows_[next_row_])) return rows_[next_row_++];
  auto found = std::find_if(rows_.begin(), rows_.end(), is_it);
  if (found == rows_.end()) {
    Row row{offset, 0, {}};
    std::fill(std::begin(row.lanes), std::end(row.lanes), -1);
    found = rows_.insert(rows_.end(), row);
  }
  next_row_ = static_cast<std::size_t>(found - rows_.begin()) + 1;
  return *found;
}

void SlotMaker::sort_into_rows(int first, const std::vector<EdgeLane>& lanes, int num_nodes) {
  rows_.clear();
  rest_.clear();
  next_row_ = 0;
  for (std::size_t l = 0; l < lanes.size(); ++l) {
    const EdgeLane& lane = lanes[l];
    const int offset = lane.other - lane.node;
    const bool fits = first + offset >= 0 && first + offset + kNodeBlock <= padded_size(num_nodes);
    Row* const row = fits ? &row_at(offset) : nullptr;
    if (row == nullptr || row->lanes[lane.node - first] >= 0) {
      rest_.push_back(static_cast<int>(l));
      continue;
    }
    row->lanes[lane.node - first] = static_cast<int>(l);
    ++row->num_lanes;
  }
  std::sort(rows_.begin(), rows_.end(),
            [](const Row& a, const Row& b) { return a.offset < b.offset; });
}

/// The k-th of each node's others to the k-th slot.
void SlotMaker::add_scattered(int first, const std::vector<EdgeLane>& lanes, EdgeSlots& slots) {
  int taken[kNodeBlock] = {};
  const int begin = slots.num_slots();
  for (const int l : rest_) {
    const EdgeLane& lane = lanes[at(l)];
    const int k = taken[lane.node - first]++;
    if (begin + k == slots.num_slots()) open_slot(first, {0, true}, slots);
    fill(begin + k, lane, slots);
  }
}

void SlotMaker::append(int block, const std::vector<EdgeLane>& lanes, EdgeSlots& slots) {
  const int first = block * kNodeBlock;
  SlotRange range{slots.num_slots(), 0, 0};
  sort_into_rows(first, lanes, slots.num_nodes);
  for (const Row& row : rows_) {
    const bool is_slot = row.num_lanes >= kFewestInARow;
    if (is_slot) open_slot(first, {row.offset, false}, slots);
    for (const int l : row.lanes) {
      if (l < 0) continue;
      if (is_slot) {
        fill(slots.num_slots() - 1, lanes[at(l)], slots);
      } else {
        rest_.push_back(l);
      }
    }
  }
  range.rows_end = slots.num_slots();
  add_scattered(first, lanes, slots);
  range.end = slots.num_slots();
  slots.blocks.push_back(range);
}

EdgeSlots make_edge_slots(const Edges& edges, int num_nodes) {
  EdgeSlots result;
  result.num_nodes = num_nodes;
  const auto num_blocks = at(padded_size(num_nodes) / kNodeBlock);
  std::vector<std::size_t> starts(num_blocks + 1, 0);
  for (const int node : edges.reshaped()) ++starts[at(node / kNodeBlock) + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  std::vector<EdgeLane> lanes(at(static_cast<int>(edges.size())));
  for (int e = 0; e < static_cast<int>(edges.cols()); ++e) {
    const int a = edges(0, e);
    const int b = edges(1, e);
    lanes[next[at(a / kNodeBlock)]++] = {a, b, e};
    lanes[next[at(b / kNodeBlock)]++] = {b, a, e};
  }
  SlotMaker maker;
  std::vector<EdgeLane> of_block;
  for (std::size_t block = 0; block < num_blocks; ++block) {
    const auto begin = lanes.begin() + static_cast<std::ptrdiff_t>(starts[block]);
    const auto end = lanes.begin() + static_cast<std::ptrdiff_t>(starts[block + 1]);
    of_block.assign(begin, end);
    maker.append(static_cast<int>(block), of_block, result);
  }
  return result;
}

}  // namespace weft::fast
