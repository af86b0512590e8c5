#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gtest/gtest.h>

#include <weft/scenes/recording/recording.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::TemporaryFolder;
using samples::write_sample;

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool can_run(const std::string& command) {
  return std::system((command + " > /dev/null 2>&1").c_str()) == 0;
}

class FormatDocumentOf : public testing::TestWithParam<StoredPrecision> {};

TEST_P(FormatDocumentOf, HasAnExampleThatReadsTheSameNumbers) {
  if (!can_run("python3 -c 'import sqlite3'") || !can_run("zstd --version")) {
    GTEST_SKIP() << "needs python3 and zstd";
  }
  const std::string document = read_text(WEFT_SOURCE_DIR "/docs/recording_format.md");
  const std::string fence = "```python\n";
  const std::size_t begin = document.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = document.find("```", begin + fence.size());
  const TemporaryFolder folder;
  std::ofstream(folder / "example.py")
      << document.substr(begin + fence.size(), end - begin - fence.size());

  constexpr int kNumFrames = 20;
  const Scene scene = make_scene();
  write_sample(folder / "a", scene, GetParam(), kNumFrames, {.frames = 6});
  const std::string run =
      "cd '" + folder.path().string() + "' && python3 example.py a > example.out";
  ASSERT_EQ(std::system(run.c_str()), 0);

  // Python's repr() gives the shortest text that reads back to the same double.
  std::istringstream lines(read_text(folder / "example.out"));
  int num_frames = 0;
  std::string time;
  std::string x;
  std::string y;
  std::string z;
  for (; lines >> time >> x >> y >> z; ++num_frames) {
    const SceneState state = make_state(scene, num_frames, GetParam());
    EXPECT_EQ(std::stod(time), state.time);
    EXPECT_EQ(std::stod(x), state.cloths[0].positions(0, 24));
    EXPECT_EQ(std::stod(y), state.cloths[0].positions(1, 24));
    EXPECT_EQ(std::stod(z), state.cloths[0].positions(2, 24));
  }
  EXPECT_EQ(num_frames, kNumFrames);
}

INSTANTIATE_TEST_SUITE_P(BothPrecisions, FormatDocumentOf,
                         testing::Values(StoredPrecision::kFloat32, StoredPrecision::kFloat64));

}  // namespace
}  // namespace weft::scenes
