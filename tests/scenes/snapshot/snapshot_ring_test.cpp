#include <weft/scenes/snapshot/snapshot_ring.hpp>

#include <gtest/gtest.h>

namespace weft::scenes {
namespace {

Snapshot snapshot_of(int step, std::size_t size) {
  Snapshot snapshot;
  snapshot.step = step;
  snapshot.state.resize(size);
  return snapshot;
}

TEST(SnapshotRing, KeepsTheLatestWithinItsBudget) {
  SnapshotRing ring(1000);
  for (int step = 0; step < 50; ++step) ring.add(snapshot_of(step, 300));
  EXPECT_EQ(ring.count(), 3U);
  EXPECT_EQ(ring.size(), 900U);
  EXPECT_EQ(ring.before(100)->step, 49);
  EXPECT_EQ(ring.before(48)->step, 48);
  EXPECT_EQ(ring.before(46), nullptr);
}

TEST(SnapshotRing, GivesTheLatestBeforeAStepThatItDoesNotHave) {
  SnapshotRing ring(1000);
  for (int step = 0; step < 50; step += 10) ring.add(snapshot_of(step, 100));
  EXPECT_EQ(ring.before(29)->step, 20);
  EXPECT_EQ(ring.before(9)->step, 0);
  EXPECT_EQ(ring.before(-1), nullptr);
}

TEST(SnapshotRing, ForgetsAFutureThatTheRunHasComeBackFrom) {
  SnapshotRing ring(1000);
  for (int step = 0; step < 5; ++step) ring.add(snapshot_of(step, 100));
  ring.add(snapshot_of(2, 150));
  EXPECT_EQ(ring.count(), 3U);
  EXPECT_EQ(ring.before(100)->size(), 150U);
  EXPECT_EQ(ring.size(), 350U);
}

TEST(SnapshotRing, KeepsNoneThatIsLargerThanItsBudget) {
  SnapshotRing ring(1000);
  ring.add(snapshot_of(1, 100));
  ring.add(snapshot_of(2, 2000));
  EXPECT_EQ(ring.count(), 0U);
  EXPECT_EQ(ring.size(), 0U);
  ring.add(snapshot_of(3, 100));
  EXPECT_EQ(ring.count(), 1U);
  ring.clear();
  EXPECT_EQ(ring.before(3), nullptr);
}

}  // namespace
}  // namespace weft::scenes
