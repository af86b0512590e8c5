#include <fstream>
#include <iterator>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/recorder/recorder.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "tests/recorder/small_world.hpp"
#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::recorder {
namespace {

using scenes::RecordingReader;
using scenes::samples::TemporaryFolder;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct RecorderOutputTest : testing::Test {
  RecorderOutputTest() { cloth = &world.add_patch(3, 1.0); }
  void record_frames(Recorder& recorder, int frames) const {
    recorder.add(*cloth, "cape");
    for (int i = 0; i < frames; ++i) EXPECT_TRUE(recorder.record(i));
  }
  [[nodiscard]] int num_files() const {
    const std::filesystem::directory_iterator files(folder.path());
    return static_cast<int>(std::distance(begin(files), end(files)));
  }

  TemporaryFolder folder;
  std::filesystem::path path = folder / "a.weftrec";
  std::filesystem::path partial = folder / "a.partial.weftrec";
  SmallWorld world;
  btSoftBody* cloth = nullptr;
};

TEST_F(RecorderOutputTest, DestructorCompletesIt) {
  {
    Recorder recorder(path);
    record_frames(recorder, 3);
    EXPECT_TRUE(std::filesystem::exists(partial));
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  EXPECT_EQ(RecordingReader(path).num_frames(), 3);
  EXPECT_EQ(num_files(), 1);
}

TEST_F(RecorderOutputTest, ExceptionLeavesThePartialRecording) {
  try {
    Recorder recorder(path);
    record_frames(recorder, 3);
    throw std::runtime_error("the game has crashed");
  } catch (const std::runtime_error&) {
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(num_files(), 1);
  const RecordingReader reader(partial);
  EXPECT_EQ(reader.num_frames(), 3);
  EXPECT_FALSE(reader.finished());
}

TEST_F(RecorderOutputTest, NothingIsLeftOfARecordingWithoutAFrame) {
  {
    Recorder recorder(path);
    recorder.add(*cloth, "cape");
    EXPECT_THAT([&] { recorder.finish(); },
                ThrowsMessage<Error>(HasSubstr("has no frame, expected record() before finish()")));
  }
  EXPECT_EQ(num_files(), 0);
}

TEST_F(RecorderOutputTest, NoFrameFollowsTheEnd) {
  Recorder recorder(path);
  record_frames(recorder, 2);
  recorder.finish();
  EXPECT_THAT([&] { recorder.record(5); },
              ThrowsMessage<InvalidArgument>(HasSubstr("is finished, expected no further frame")));
  EXPECT_THAT([&] { recorder.add(*cloth, "late"); },
              ThrowsMessage<InvalidArgument>(HasSubstr("late")));
}

TEST_F(RecorderOutputTest, FilesThatAreThereStay) {
  std::ofstream(folder / "notes.weftrec") << "notes";
  EXPECT_THAT([&] { const Recorder recorder(folder / "notes.weftrec", {.may_replace = true}); },
              ThrowsMessage<InvalidArgument>(HasSubstr("notes.weftrec")));
  {
    Recorder recorder(path);
    record_frames(recorder, 2);
  }
  EXPECT_THAT([&] { const Recorder recorder(path); },
              ThrowsMessage<InvalidArgument>(HasSubstr("a.weftrec")));
  EXPECT_EQ(RecordingReader(path).num_frames(), 2);
  {
    Recorder recorder(path, {.may_replace = true});
    record_frames(recorder, 5);
    EXPECT_EQ(RecordingReader(path).num_frames(), 2);  // until the new one is whole
  }
  EXPECT_EQ(RecordingReader(path).num_frames(), 5);
}

TEST_F(RecorderOutputTest, TwoRecordersCannotHaveOneOutput) {
  Recorder first(path);
  record_frames(first, 1);
  EXPECT_THAT([&] { const Recorder second(path); }, ThrowsMessage<Error>(HasSubstr("a.weftrec")));
  first.finish();
  EXPECT_EQ(RecordingReader(path).num_frames(), 1);
}

}  // namespace
}  // namespace weft::recorder
