#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/recorder/recorder.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "tests/recorder/small_world.hpp"
#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::recorder {
namespace {

using scenes::Mark;
using scenes::MarkKind;
using scenes::RecordingReader;
using scenes::samples::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

btVector3 vector(double x, double y, double z) {
  return {static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)};
}

struct RecorderMarksTest : testing::Test {
  RecorderMarksTest() : recorder(path, {.frame_interval = 1.0}) {
    cloth = &world.add_patch(3, 1.0);
    recorder.add(*cloth, "cape");
  }

  TemporaryFolder folder;
  std::filesystem::path path = folder / "a.weftrec";
  SmallWorld world;
  Recorder recorder;
  btSoftBody* cloth = nullptr;
};

TEST_F(RecorderMarksTest, PointsLinesAndArrowsComeBackWithTheirFrame) {
  const std::vector<btVector3> origins = {vector(1, 2, 3), vector(0, 0, 0)};
  const std::vector<btVector3> vectors = {vector(0, 0.5, 0), vector(0, 0, 1)};
  for (int step = 0; step < 5; ++step) {
    const bool is_due = recorder.begin_frame(0.5 * step);
    EXPECT_EQ(is_due, step % 2 == 0) << step;
    recorder.log_points("contact", origins);
    recorder.log_lines("path", origins, vectors);
    recorder.log_arrows("force", origins, vectors);
    if (step == 4) recorder.log_points("contact", {});
    EXPECT_EQ(recorder.end_frame(), is_due);
  }
  recorder.record(3.0);
  recorder.finish();
  const RecordingReader reader(path);
  ASSERT_EQ(reader.num_frames(), 4);
  EXPECT_THAT(reader.marks(2), SizeIs(4));
  EXPECT_THAT(reader.marks(3), IsEmpty());
  const std::vector<Mark> marks = reader.marks(1);
  ASSERT_THAT(marks, SizeIs(3));
  EXPECT_EQ(marks[0].kind, MarkKind::kPoints);
  EXPECT_EQ(marks[0].name, "contact");
  EXPECT_EQ(marks[0].from.col(0), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(marks[1].kind, MarkKind::kLines);
  EXPECT_EQ(marks[1].to.col(0), Eigen::Vector3f(0, 0.5, 0));
  EXPECT_EQ(marks[2].kind, MarkKind::kArrows);
  EXPECT_EQ(marks[2].to.col(0), Eigen::Vector3f(1, 2.5, 3)) << "the end, not the vector";
  EXPECT_NE(marks[0].color, marks[1].color);
  EXPECT_EQ(marks[2].color, reader.marks(2)[2].color) << "one name, one color";
}

TEST_F(RecorderMarksTest, EventsAndMetricsHaveTheTimeOfTheFrameThatHasBegun) {
  recorder.begin_frame(0.0);
  recorder.event("begins");
  recorder.metric("force_N", 2.0);
  recorder.end_frame();
  recorder.begin_frame(0.25);
  recorder.event("between two frames");
  recorder.end_frame();
  recorder.record(1.0);
  recorder.event("after the last one");
  recorder.finish();
  const RecordingReader reader(path);
  const std::vector<scenes::Note> notes = reader.notes();
  ASSERT_THAT(notes, SizeIs(3));
  EXPECT_EQ(notes[0].time, 0.0);
  EXPECT_EQ(notes[1].time, 0.25);
  EXPECT_EQ(notes[1].text, "between two frames");
  EXPECT_EQ(notes[2].time, 1.0);
  ASSERT_THAT(reader.metric("force_N"), SizeIs(1));
  EXPECT_EQ(reader.metric("force_N")[0].time, 0.0);
}

TEST_F(RecorderMarksTest, BodiesAreReadAtTheEndOfTheFrame) {
  recorder.begin_frame(0.0);
  cloth->m_nodes[0].m_x = vector(7, 0, 0);
  recorder.end_frame();
  recorder.finish();
  EXPECT_EQ(RecordingReader(path).frame(0).cloths[0].positions(0, 0), 7.0);
}

TEST_F(RecorderMarksTest, ABlowUpInAFrameThatIsNotDueTakesOne) {
  recorder.record(0.0);
  EXPECT_FALSE(recorder.begin_frame(0.25));
  recorder.blow_up(*cloth, 3, "too fast");
  EXPECT_TRUE(recorder.end_frame());
  recorder.finish();
  EXPECT_EQ(RecordingReader(path).num_frames(), 2);
}

TEST_F(RecorderMarksTest, WhatIsOutOfOrderIsRefused) {
  const std::vector<btVector3> one = {vector(0, 0, 0)};
  const auto says = [](const auto& call, const char* text) {
    EXPECT_THAT(call, ThrowsMessage<InvalidArgument>(HasSubstr(text)));
  };
  says([&] { recorder.log_points("contact", one); }, "points 'contact', expected it between");
  says([&] { recorder.end_frame(); }, "end_frame(), expected it between");
  says([&] { recorder.event("early"); }, "event 'early' comes before the first frame");
  recorder.begin_frame(0.0);
  says([&] { recorder.begin_frame(1.0); }, "a frame in a frame");
  says([&] { recorder.record(1.0); }, "a frame in a frame");
  says([&] { recorder.log_lines("path", one, {}); }, "lines 'path': 0 ends, expected 1");
  says([&] { recorder.log_arrows("", one, one); }, "arrows: have no name");
  recorder.end_frame();
  recorder.finish();
  says([&] { recorder.event("late"); }, "event 'late' comes before the first frame or after");
}

}  // namespace
}  // namespace weft::recorder
