#include <weft/viewer/model/frames/frame_ring.hpp>

#include <gtest/gtest.h>

namespace weft::viewer {
namespace {

SnapshotPtr frame(int step, int num_nodes = 1) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->step = step;
  snapshot->state.cloths.push_back(
      {"cloth", Matrix3X<double>::Zero(3, num_nodes), Matrix3X<double>::Zero(3, num_nodes)});
  return snapshot;
}

TEST(FrameRing, KeepsTheLatestFrames) {
  FrameRing ring(3);
  for (int i = 0; i < 5; ++i) ring.add(frame(i));
  ASSERT_EQ(ring.size(), 3u);
  EXPECT_EQ(ring.at(0)->step, 2);
  EXPECT_EQ(ring.at(2)->step, 4);
}

TEST(FrameRing, KeepsToItsMemoryButAlwaysTheNewest) {
  FrameRing ring(100, 100'000);
  for (int i = 0; i < 10; ++i) ring.add(frame(i, 1000));  // 48 kB each
  EXPECT_EQ(ring.size(), 2u);
  ring.add(frame(10, 10'000));
  ASSERT_EQ(ring.size(), 1u);
  EXPECT_EQ(ring.at(0)->step, 10);
  ring.clear();
  EXPECT_EQ(ring.size(), 0u);
}

}  // namespace
}  // namespace weft::viewer
