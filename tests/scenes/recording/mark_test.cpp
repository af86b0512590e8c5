#include <weft/scenes/recording/mark.hpp>

#include <sqlite3.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/recording/playback_copy.hpp>
#include <weft/scenes/recording/trim.hpp>
#include <weft/scenes/recording/verify.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr auto kMarkPrecision = StoredPrecision::kFloat32;

Mark arrows(int frame) {
  Mark mark{MarkKind::kArrows, "force", {10, 20, 30}, {}, {}};
  mark.from = Matrix3X<float>::Constant(3, 2, static_cast<float>(frame));
  mark.to = mark.from.array() + 0.1f;
  return mark;
}

Mark points(int count) {
  return {MarkKind::kPoints,
          "contact",
          {255, 0, 1},
          Matrix3X<float>::Ones(3, count),
          Matrix3X<float>(3, 0)};
}

/// Frames 0 to 9; those with an odd number have arrows, frame 3 points too.
std::string write_marked(const std::filesystem::path& path, bool has_marks = true) {
  const Scene scene = make_scene();
  RecordingWriter writer(path, scene, {}, kMarkPrecision, {.frames = 4});
  for (int frame = 0; frame < 10; ++frame) {
    std::vector<Mark> marks;
    if (has_marks && frame % 2 == 1) marks.push_back(arrows(frame));
    if (has_marks && frame == 3) marks.push_back(points(5));
    writer.add_frame(make_state(scene, frame, kMarkPrecision), marks);
    if (has_marks && frame == 6) writer.add_note({frame / 60.0, "the gripper lets go"});
  }
  return writer.finish();
}

void execute(const std::filesystem::path& path, const char* sql) {
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(connection, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sql;
  sqlite3_close(connection);
}

TEST(Marks, ComeBackWithTheirFrame) {
  const TemporaryFolder folder;
  write_marked(folder / "a");
  const RecordingReader reader(folder / "a");
  for (int frame = 0; frame < 10; ++frame) {
    const std::vector<Mark> marks = reader.marks(frame);
    ASSERT_EQ(marks.size(), frame == 3 ? 2U : static_cast<std::size_t>(frame % 2)) << frame;
    if (marks.empty()) continue;
    EXPECT_EQ(marks[0].kind, MarkKind::kArrows);
    EXPECT_EQ(marks[0].name, "force");
    EXPECT_EQ(marks[0].color, (Rgb{10, 20, 30}));
    EXPECT_EQ(marks[0].from, arrows(frame).from);
    EXPECT_EQ(marks[0].to, arrows(frame).to);
  }
  const Mark five = reader.marks(3)[1];
  EXPECT_EQ(five.kind, MarkKind::kPoints);
  EXPECT_EQ(five.from.cols(), 5);
  EXPECT_EQ(five.to.cols(), 0);
  ASSERT_EQ(reader.notes().size(), 1U);
  EXPECT_EQ(reader.notes()[0].time, 0.1);
  EXPECT_EQ(reader.notes()[0].text, "the gripper lets go");
  EXPECT_THROW((void)reader.marks(10), InvalidArgument);
}

TEST(Marks, AreNoPartOfTheContentHashAndLeaveNoTraceWhereThereIsNone) {
  const TemporaryFolder folder;
  const std::string hash = write_marked(folder / "plain", false);
  EXPECT_EQ(write_marked(folder / "a"), hash);
  const RecordingReader plain(folder / "plain");
  EXPECT_THAT(plain.marks(3), IsEmpty());
  EXPECT_THAT(plain.notes(), IsEmpty());
}

TEST(Marks, OfAGrowingRecordingAreThoseOfItsCommittedFrames) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  RecordingWriter writer(folder / "a", scene, {}, kMarkPrecision, {.frames = 2});
  for (int frame = 0; frame < 3; ++frame) {
    writer.add_frame(make_state(scene, frame, kMarkPrecision), std::vector<Mark>{arrows(frame)});
  }
  const RecordingReader reader(folder / "a");
  ASSERT_EQ(reader.num_frames(), 2);
  for (int frame = 3; frame < 9; ++frame) {
    writer.add_frame(make_state(scene, frame, kMarkPrecision), std::vector<Mark>{arrows(frame)});
  }
  // Rows that came later are not those that the header has counted.
  EXPECT_EQ(reader.marks(0).size() + reader.marks(1).size(), 2U);
}

TEST(Marks, ComeAlongInATrim) {
  const TemporaryFolder folder;
  write_marked(folder / "a");
  const RecordingReader a(folder / "a");
  const TrimRange range{.from = 2 / 60.0, .to = 7 / 60.0};
  RecordingWriter writer(folder / "b", a.scene(), trimmed_provenance(a, range), a.precision());
  copy_range(a, range, writer);
  writer.finish();
  const RecordingReader b(folder / "b");
  ASSERT_EQ(b.num_frames(), 6);
  EXPECT_THAT(b.marks(0), IsEmpty());
  EXPECT_EQ(b.marks(1).size(), 2U);
  EXPECT_EQ(b.marks(5)[0].from, arrows(7).from);
  EXPECT_EQ(b.notes().size(), 1U);
}

TEST(Marks, GoIntoACopyForThePage) {
  const TemporaryFolder folder;
  const std::string path = folder / "a";
  write_marked(path);
  const std::string copy = playback_copy(RecordingReader(path), {});
  EXPECT_THAT(copy, HasSubstr("CREATE TABLE mark"));
  EXPECT_THAT(copy, HasSubstr("the gripper lets go"));
}

TEST(Marks, ThatAreDamagedAreNoticed) {
  for (const char* sql :
       {"UPDATE mark SET name = 'other' WHERE id = 1", "UPDATE mark SET data = x'00' WHERE id = 1",
        "DELETE FROM mark WHERE id = 1", "DROP TABLE mark", "UPDATE mark SET frame = 0",
        "UPDATE event SET reason = 'nothing'", "DELETE FROM event"}) {
    const TemporaryFolder folder;
    write_marked(folder / "a");
    execute(folder / "a", sql);
    const RecordingReader reader(folder / "a");
    const Verification verification = verify_recording(reader, {});
    EXPECT_FALSE(verification.faults.empty()) << sql;
    EXPECT_EQ(verification.num_readable, 10) << sql;
  }
}

TEST(Marks, OfAWrongShapeAreRefused) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  RecordingWriter writer(folder / "a", scene, {}, kMarkPrecision);
  const SceneState state = make_state(scene, 0, kMarkPrecision);
  Mark mark = arrows(0);
  mark.to = Matrix3X<float>(3, 1);
  try {
    writer.add_frame(state, std::vector<Mark>{points(1), mark});
    FAIL() << "nothing was thrown";
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("arrows 'force': 1 ends, expected 2"));
  }
  mark = points(1);
  mark.name.clear();
  EXPECT_THROW(writer.add_frame(state, std::vector<Mark>{mark}), InvalidArgument);
  writer.add_frame(state, std::vector<Mark>{points(2)});  // refused ones have left nothing
  EXPECT_THROW(writer.add_note({0.0, ""}), InvalidArgument);
  EXPECT_THROW(writer.add_note({NAN, "when?"}), InvalidArgument);
  writer.finish();
  const RecordingReader reader(folder / "a");
  EXPECT_EQ(reader.num_frames(), 1);
  ASSERT_EQ(reader.marks(0).size(), 1U);
  EXPECT_EQ(reader.marks(0)[0].from.cols(), 2);
}

}  // namespace
}  // namespace weft::scenes
