#include <weft/fast_solver/edge_slots.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace weft::fast {
namespace {

/// Neighbours at the same distance from which on a slot of their own is faster than fetching them one
/// by one.
constexpr int kFewestInARow = 4;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// An edge as one of its ends sees it.
struct Lane {
  int node;
  int other;
  int edge;
};

class SlotMaker {
 public:
  SlotMaker(const Edges& edges, int num_nodes)
      : lanes_(at(fill_up(num_nodes) / kNodeBlock)), num_rows_(fill_up(num_nodes)) {
    result_.num_nodes = num_nodes;
    for (int e = 0; e < static_cast<int>(edges.cols()); ++e) {
      const int a = edges(0, e);
      const int b = edges(1, e);
      lanes_[at(a / kNodeBlock)].push_back({a, b, e});
      lanes_[at(b / kNodeBlock)].push_back({b, a, e});
    }
  }

  EdgeSlots run() {
    for (int block = 0; block < static_cast<int>(lanes_.size()); ++block) {
      SlotRange range{};
      range.begin = result_.num_slots();
      const std::vector<Lane> rest = add_rows(block * kNodeBlock, lanes_[at(block)]);
      range.rows_end = result_.num_slots();
      add_scattered(block * kNodeBlock, rest);
      range.end = result_.num_slots();
      result_.blocks.push_back(range);
    }
    return std::move(result_);
  }

 private:
  /// Slots in a row: by the distance of the neighbours, each node at most once. Returns what is left.
  std::vector<Lane> add_rows(int first, const std::vector<Lane>& lanes) {
    std::map<int, std::vector<Lane>> rows;
    std::vector<Lane> rest;
    for (const Lane& lane : lanes) {
      const int offset = lane.other - lane.node;
      const bool fits = first + offset >= 0 && first + offset + kNodeBlock <= num_rows_;
      std::vector<Lane>& row = rows[offset];
      const bool is_taken =
          std::any_of(row.begin(), row.end(), [&](const Lane& l) { return l.node == lane.node; });
      (fits && !is_taken ? row : rest).push_back(lane);
    }
    for (const auto& [offset, row] : rows) {
      if (static_cast<int>(row.size()) < kFewestInARow) {
        rest.insert(rest.end(), row.begin(), row.end());
        continue;
      }
      open_slot(first, {offset, false});
      for (const Lane& lane : row) fill(result_.num_slots() - 1, lane);
    }
    return rest;
  }

  /// The k-th of each node's others to the k-th slot.
  void add_scattered(int first, const std::vector<Lane>& lanes) {
    std::vector<int> taken(kNodeBlock, 0);
    const int begin = result_.num_slots();
    for (const Lane& lane : lanes) {
      const int k = taken[at(lane.node - first)]++;
      if (begin + k == result_.num_slots()) open_slot(first, {0, true});
      fill(begin + k, lane);
    }
  }

  void open_slot(int first, const EdgeSlot& slot) {
    result_.slots.push_back(slot);
    for (int lane = 0; lane < kNodeBlock; ++lane) {
      result_.others.push_back(std::min(first + lane, result_.num_nodes - 1));
      result_.edges.push_back(-1);
    }
  }

  void fill(int slot, const Lane& lane) {
    const std::size_t place = at(slot * kNodeBlock + lane.node % kNodeBlock);
    result_.others[place] = lane.other;
    result_.edges[place] = lane.edge;
  }

  std::vector<std::vector<Lane>> lanes_;  ///< of each block
  int num_rows_;
  EdgeSlots result_;
};

}  // namespace

EdgeSlots make_edge_slots(const Edges& edges, int num_nodes) {
  return SlotMaker(edges, num_nodes).run();
}

}  // namespace weft::fast
