#include <weft/scenes/recording/recording_output.hpp>

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

namespace fs = std::filesystem;
using samples::make_scene;
using samples::make_state;
using samples::TemporaryFolder;
using samples::write_sample;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto kRecordingOutputPrecision = StoredPrecision::kFloat64;

int num_files(const TemporaryFolder& folder) {
  const fs::directory_iterator files(folder.path());
  return static_cast<int>(std::distance(begin(files), end(files)));
}

template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(RecordingOutput, IsPartialUntilItIsWhole) {
  const TemporaryFolder folder;
  {
    const RecordingOutput output(folder / "a.weftrec", false);
    EXPECT_EQ(output.partial(), folder / "a.partial.weftrec");
    write_sample(output.partial(), make_scene(), kRecordingOutputPrecision, 3);
    EXPECT_FALSE(fs::exists(folder / "a.weftrec"));
    output.publish();
  }
  EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 3);
  EXPECT_EQ(num_files(folder), 1);
}

TEST(RecordingOutput, OfAnEarlierRunIsKeptAndNamed) {
  const TemporaryFolder folder;
  write_sample(folder / "a.partial.weftrec", make_scene(), kRecordingOutputPrecision, 2);
  write_sample(folder / "a.partial-2.weftrec", make_scene(), kRecordingOutputPrecision, 3);
  {
    const RecordingOutput output(folder / "a.weftrec", true);
    EXPECT_THAT(output.earlier(),
                ElementsAre(folder / "a.partial.weftrec", folder / "a.partial-2.weftrec"));
    EXPECT_EQ(output.partial(), folder / "a.partial-3.weftrec");
    write_sample(output.partial(), make_scene(), kRecordingOutputPrecision, 4);
    output.publish();
  }
  EXPECT_EQ(RecordingReader(folder / "a.partial.weftrec").num_frames(), 2);
  EXPECT_EQ(RecordingReader(folder / "a.partial-2.weftrec").num_frames(), 3);
  EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 4);
}

TEST(RecordingOutput, HasOneRunAtATime) {
  const TemporaryFolder folder;
  const RecordingOutput first(folder / "a.weftrec", false);
  EXPECT_THROW(RecordingOutput(folder / "a.weftrec", true), Error);
  EXPECT_NO_THROW(RecordingOutput(folder / "b.weftrec", false));
}

TEST(RecordingOutput, ReplacesARecordingWithForceAndItsLogToo) {
  const TemporaryFolder folder;
  write_sample(folder / "a.weftrec", make_scene(), kRecordingOutputPrecision, 1);
  EXPECT_THAT(message_of([&] { RecordingOutput(folder / "a.weftrec", false); }),
              HasSubstr("--force"));
  std::ofstream(folder / "a.weftrec-wal") << "log of the old one";
  {
    const RecordingOutput output(folder / "a.weftrec", true);
    write_sample(output.partial(), make_scene(), kRecordingOutputPrecision, 5);
    EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 1);
    output.publish();
  }
  EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 5);
  EXPECT_EQ(num_files(folder), 1);
}

TEST(RecordingOutput, ARecordingThatAppearsMeanwhileStays) {
  const TemporaryFolder folder;
  const RecordingOutput output(folder / "a.weftrec", true);
  write_sample(output.partial(), make_scene(), kRecordingOutputPrecision, 3);
  write_sample(folder / "a.weftrec", make_scene(), kRecordingOutputPrecision, 7);
  EXPECT_THAT(message_of([&] { output.publish(); }), HasSubstr("a-2.weftrec"));
  EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 7);
  EXPECT_EQ(RecordingReader(folder / "a-2.weftrec").num_frames(), 3);
}

TEST(RecordingOutput, RefusesTheNameOfALogWithoutItsRecording) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.weftrec-wal") << "frames of a recording that was moved";
  EXPECT_THROW(RecordingOutput(folder / "a.weftrec", true), InvalidArgument);
  EXPECT_EQ(num_files(folder), 1);
}

TEST(RecordingWriter, TellsWhatAReaderWouldFind) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  RecordingWriter writer(folder / "a.weftrec", scene, {}, kRecordingOutputPrecision, {.frames = 4});
  for (int i = 0; i < 6; ++i) writer.add_frame(make_state(scene, i, kRecordingOutputPrecision));
  EXPECT_EQ(writer.committed().frames, 4);
  EXPECT_EQ(writer.committed().time, make_state(scene, 3, kRecordingOutputPrecision).time);
  EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 4);
  writer.commit();
  EXPECT_EQ(writer.committed().frames, 6);
  EXPECT_EQ(RecordingReader(folder / "a.weftrec").num_frames(), 6);
}

}  // namespace
}  // namespace weft::scenes
