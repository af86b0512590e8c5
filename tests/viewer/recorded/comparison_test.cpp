#include <weft/viewer/recorded/comparison.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include <weft/core/error.hpp>

#include "tests/viewer/support.hpp"

namespace weft::viewer {
namespace {

TEST(Comparisons, OneRecordingHasNoGhosts) {
  Comparison one({write_recording("one", 1.0, 5)});
  EXPECT_FALSE(one.has_ghosts());
  EXPECT_EQ(one.num_frames(), 5);
  EXPECT_EQ(one.drawn_scene().cloths.size(), 1u);
  const SnapshotPtr frame = one.frame(3);
  EXPECT_NEAR(frame->state.time, 0.3, 1e-12);
  EXPECT_NEAR(frame->measures.kinetic_energy, 0.5 * 0.4, 1e-12);
  EXPECT_EQ(one.frame(3), frame) << "is kept";
}

TEST(Comparisons, GhostsAreDrawnAtTheSameTime) {
  Comparison two({write_recording("a", 1.0, 5), write_recording("b", 2.0, 3)});
  EXPECT_TRUE(two.has_ghosts());
  ASSERT_EQ(two.drawn_scene().cloths.size(), 2u);
  ASSERT_EQ(two.drawn_scene().colliders.size(), 3u) << "the stone is there once";
  EXPECT_EQ(two.ghosts().first_cloth, 1u);
  EXPECT_EQ(two.ghosts().first_collider, 2u);
  const SnapshotPtr frame = two.frame(1);
  EXPECT_NEAR(frame->state.cloths[0].positions(1, 0), -0.1, 1e-12);
  EXPECT_NEAR(frame->state.cloths[1].positions(1, 0), -0.2, 1e-12);
  EXPECT_NEAR(frame->state.rigids[2].position.x(), 0.1, 1e-12);
  // A shorter one stays at its end.
  EXPECT_NEAR(two.frame(4)->state.cloths[1].positions(1, 0), -0.4, 1e-12);
  EXPECT_NEAR(two.frame(4)->measures.kinetic_energy, 0.5 * 0.4, 1e-12) << "of the solid one";
}

TEST(Comparisons, TheSolidOneChanges) {
  Comparison two({write_recording("a", 1.0, 5), write_recording("b", 2.0, 3)});
  two.next();
  EXPECT_EQ(two.solid(), 1u);
  EXPECT_EQ(two.num_frames(), 3);
  EXPECT_NEAR(two.frame(1)->state.cloths[0].positions(1, 0), -0.2, 1e-12);
  two.show_ghosts(false);
  EXPECT_EQ(two.drawn_scene().cloths.size(), 1u);
  EXPECT_EQ(two.frame(1)->state.cloths.size(), 1u);
  two.next();
  EXPECT_EQ(two.solid(), 0u);
}

TEST(Comparisons, FindsTheFrameOfATime) {
  const Comparison one({write_recording("one", 1.0, 5)});
  EXPECT_EQ(one.frame_at(-1.0), 0);
  EXPECT_EQ(one.frame_at(0.0), 0);
  EXPECT_EQ(one.frame_at(0.25), 2);
  EXPECT_EQ(one.frame_at(0.3), 3);
  EXPECT_EQ(one.frame_at(9.0), 4);
}

TEST(Comparisons, MeasuresAllFramesForThePlots) {
  Comparison one({write_recording("one", 1.0, 5)});
  EXPECT_FALSE(one.measures().at(4));
  while (!one.measure_more(0.01)) {
  }
  for (const auto& measures : one.measures()) {
    ASSERT_TRUE(measures);
    EXPECT_NEAR(measures->kinetic_energy, 0.2, 1e-12);
  }
}

TEST(Comparisons, WhatIsNoRecordingIsNamed) {
  const std::string path = testing::TempDir() + "weft_viewer_text.weftrec";
  std::ofstream(path) << "no recording";
  EXPECT_THAT([&] { Comparison({path}); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("weft_viewer_text")));
  const auto empty = write_recording("empty", 1.0, 0);
  EXPECT_THAT([&] { Comparison({empty}); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("has no frame")));
}

}  // namespace
}  // namespace weft::viewer
