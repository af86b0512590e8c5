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
  SlotMaker(const Edges& edges, int num_nodes, int blocks_per_task)
      : num_blocks_(fill_up(num_nodes) / kNodeBlock), blocks_per_task_(blocks_per_task) {
    result_.num_nodes = num_nodes;
    mutual_.resize(at(num_blocks_));
    single_.resize(at(num_blocks_));
    for (int e = 0; e < static_cast<int>(edges.cols()); ++e) {
      const int a = std::min(edges(0, e), edges(1, e));
      const int b = std::max(edges(0, e), edges(1, e));
      if (task_of(a) == task_of(b)) {
        mutual_[at(a / kNodeBlock)].push_back({a, b, e});
      } else {
        single_[at(a / kNodeBlock)].push_back({a, b, e});
        single_[at(b / kNodeBlock)].push_back({b, a, e});
      }
    }
  }

  EdgeSlots run() {
    result_.block_starts.push_back(0);
    for (int block = 0; block < num_blocks_; ++block) {
      if (block % blocks_per_task_ == 0) result_.task_starts.push_back(block);
      const int task_end = std::min(num_blocks_, (block / blocks_per_task_ + 1) * blocks_per_task_);
      add_slots(block, mutual_[at(block)], true, task_end * kNodeBlock);
      add_slots(block, single_[at(block)], false, num_blocks_ * kNodeBlock);
      result_.block_starts.push_back(result_.num_slots());
    }
    result_.task_starts.push_back(num_blocks_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] int task_of(int node) const { return node / kNodeBlock / blocks_per_task_; }

  /// end: of the nodes that slots in a row may touch.
  void add_slots(int block, const std::vector<Lane>& lanes, bool is_mutual, int end) {
    const int first = block * kNodeBlock;
    // In a row: by the distance of the neighbours, each node at most once.
    std::map<int, std::vector<Lane>> in_a_row;
    std::vector<Lane> rest;
    for (const Lane& lane : lanes) {
      const int offset = lane.other - lane.node;
      const bool fits = first + offset >= 0 && first + offset + kNodeBlock <= end;
      std::vector<Lane>& row = in_a_row[offset];
      const bool is_taken =
          std::any_of(row.begin(), row.end(), [&](const Lane& l) { return l.node == lane.node; });
      (fits && !is_taken ? row : rest).push_back(lane);
    }
    for (const auto& [offset, row] : in_a_row) {
      if (static_cast<int>(row.size()) < kFewestInARow) {
        rest.insert(rest.end(), row.begin(), row.end());
        continue;
      }
      open_slot(first, {offset, false, is_mutual});
      for (const Lane& lane : row) fill(result_.num_slots() - 1, lane);
    }
    // The k-th of each node's others to the k-th slot.
    std::vector<int> taken(kNodeBlock, 0);
    const int begin = result_.num_slots();
    for (const Lane& lane : rest) {
      const int k = taken[at(lane.node - first)]++;
      if (begin + k == result_.num_slots()) open_slot(first, {0, true, is_mutual});
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

  int num_blocks_;
  int blocks_per_task_;
  std::vector<std::vector<Lane>> mutual_;
  std::vector<std::vector<Lane>> single_;
  EdgeSlots result_;
};

}  // namespace

EdgeSlots make_edge_slots(const Edges& edges, int num_nodes, int blocks_per_task) {
  return SlotMaker(edges, num_nodes, blocks_per_task).run();
}

}  // namespace weft::fast
