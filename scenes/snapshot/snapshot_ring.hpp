#pragma once

// Tested by tests/scenes/snapshot/snapshot_ring_test.cpp.

#include <cstddef>
#include <deque>
#include <utility>

#include <weft/scenes/snapshot/snapshot.hpp>

namespace weft::scenes {

/// The latest snapshots of one run, within a number of bytes: for steps backwards and rollback.
class SnapshotRing {
 public:
  /// budget [bytes] of states, without the scene's text, which they share.
  explicit SnapshotRing(std::size_t budget) : budget_(budget) {}

  /// Adds the latest state. Those of its step and later ones go: the run has come back from there. The oldest go until the
  /// budget is kept; a snapshot that is larger than all of it is not kept.
  void add(Snapshot snapshot) {
    while (!snapshots_.empty() && snapshots_.back().step >= snapshot.step) drop_last();
    size_ += snapshot.size();
    snapshots_.push_back(std::move(snapshot));
    while (size_ > budget_) drop_first();
  }

  /// The latest state at or before a step, or nullptr if none is kept.
  [[nodiscard]] const Snapshot* before(int step) const {
    for (auto found = snapshots_.rbegin(); found != snapshots_.rend(); ++found) {
      if (found->step <= step) return &*found;
    }
    return nullptr;
  }

  void clear() {
    snapshots_.clear();
    size_ = 0;
  }
  [[nodiscard]] std::size_t count() const { return snapshots_.size(); }
  [[nodiscard]] std::size_t size() const { return size_; }  ///< [bytes]
  [[nodiscard]] std::size_t budget() const { return budget_; }

 private:
  void drop_first() {
    size_ -= snapshots_.front().size();
    snapshots_.pop_front();
  }
  void drop_last() {
    size_ -= snapshots_.back().size();
    snapshots_.pop_back();
  }

  std::size_t budget_;
  std::size_t size_ = 0;
  std::deque<Snapshot> snapshots_;  ///< by growing step
};

}  // namespace weft::scenes
