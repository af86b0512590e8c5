#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

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

/// In place of Weft's command: writes its arguments, whether the recording is there, and ends when it is told to.
constexpr const char* kStandIn = R"(#!/bin/sh
[ -s "$2" ] && there=yes || there=no
echo "$1 $2 $there" >"$0.new"
mv "$0.new" "$0.told"
for i in $(seq 600); do [ -e "$0.close" ] && break; sleep 0.05; done
echo closed >"$0.closed"
)";

struct BackEndTest : testing::Test {
  BackEndTest() {
    std::ofstream(program) << kStandIn;
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    cloth = &world.add_patch(3, 1.0);
  }
  [[nodiscard]] RecorderOptions options(BackEnd back_end) const {
    RecorderOptions options;
    options.frame_interval = 1.0;
    options.back_end = back_end;
    options.window_program = program;
    return options;
  }
  /// Whether the file of the stand-in with this ending comes.
  [[nodiscard]] bool comes(const char* ending) const {
    for (int i = 0; i < 600 && !std::filesystem::exists(program.string() + ending); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return std::filesystem::exists(program.string() + ending);
  }
  /// "view", the recording, "yes" if it was there.
  [[nodiscard]] std::vector<std::string> told() const {
    EXPECT_TRUE(comes(".told"));
    std::ifstream file(program.string() + ".told");
    return {std::istream_iterator<std::string>(file), {}};
  }
  void close() const { std::ofstream(program.string() + ".close") << "now"; }

  TemporaryFolder folder;
  std::filesystem::path path = folder / "a.weftrec";
  std::filesystem::path program = folder / "stand_in.sh";
  SmallWorld world;
  btSoftBody* cloth = nullptr;
};

TEST_F(BackEndTest, BothWritesTheFileAndShowsItFromTheFirstFrameOn) {
  {
    Recorder recorder(path, options(BackEnd::kBoth));
    recorder.add(*cloth, "cape");
    recorder.record(0.0);
    const std::vector<std::string> words = told();
    ASSERT_EQ(words.size(), 3U);
    EXPECT_EQ(words[0], "view");
    EXPECT_EQ(words[1], (folder / "a.partial.weftrec").string());
    EXPECT_EQ(words[2], "yes");
    EXPECT_EQ(RecordingReader(words[1]).num_frames(), 1) << "the window has nothing to show";
    // A frame of 1 s is shown at once.
    recorder.record(1.0);
    EXPECT_EQ(RecordingReader(words[1]).num_frames(), 2);
  }
  // The program has gone on while the window is open.
  EXPECT_FALSE(std::filesystem::exists(program.string() + ".closed"));
  EXPECT_EQ(RecordingReader(path).num_frames(), 2);
  close();
  EXPECT_TRUE(comes(".closed"));
}

TEST_F(BackEndTest, AWindowAloneIsWaitedForAndLeavesNothing) {
  std::thread closer;
  std::filesystem::path shown;
  {
    Recorder recorder(folder / "unused.weftrec", options(BackEnd::kWindow));
    recorder.add(*cloth, "cape");
    recorder.record(0.0);
    shown = told().at(1);
    EXPECT_NE(shown.parent_path(), folder.path());
    EXPECT_TRUE(std::filesystem::exists(shown));
    recorder.finish();
    closer = std::thread([this] {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      close();
    });
  }
  EXPECT_TRUE(std::filesystem::exists(program.string() + ".closed"))
      << "the window was not waited for";
  EXPECT_FALSE(std::filesystem::exists(shown.parent_path()));
  EXPECT_FALSE(std::filesystem::exists(folder / "unused.weftrec"));
  closer.join();
}

TEST_F(BackEndTest, NoneTakesEveryCallAndWritesNothing) {
  Recorder recorder(folder / "no" / "such" / "folder.weftrec", options(BackEnd::kNone));
  recorder.add(*cloth, "cape");
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(recorder.begin_frame(i));
    const btVector3 point(0, 0, 0);
    recorder.log_points("contact", {&point, 1});
    recorder.metric("force_N", 1.0);
    recorder.event("nothing");
    EXPECT_FALSE(recorder.end_frame());
    EXPECT_FALSE(recorder.record(i + 0.5));
  }
  recorder.blow_up(*cloth, 0, "too fast");
  EXPECT_FALSE(recorder.record(9.0));
  EXPECT_EQ(recorder.finish(), "");
  EXPECT_EQ(recorder.num_frames(), 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "no"));
}

TEST_F(BackEndTest, AProgramThatIsNotThereIsNamed) {
  RecorderOptions wrong = options(BackEnd::kBoth);
  wrong.window_program = folder / "no_weft";
  Recorder recorder(path, wrong);
  recorder.add(*cloth, "cape");
  EXPECT_THAT([&] { recorder.record(0.0); },
              ThrowsMessage<Error>(HasSubstr("no_weft': No such file or directory, expected")));
}

}  // namespace
}  // namespace weft::recorder
