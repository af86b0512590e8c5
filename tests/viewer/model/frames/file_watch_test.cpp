#include <weft/viewer/model/frames/file_watch.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace weft::viewer {
namespace {

class FileWatches : public testing::Test {
 protected:
  FileWatches() : path_(testing::TempDir() + "weft_file_watch_test.toml") { write("a"); }
  ~FileWatches() override { std::filesystem::remove(path_); }
  void write(const std::string& text) const { std::ofstream(path_) << text; }
  std::filesystem::path path_;
};

TEST_F(FileWatches, NoticesASaveOnceItKeepsStill) {
  FileWatch watch(path_);
  EXPECT_FALSE(watch.was_saved());
  write("longer");
  EXPECT_FALSE(watch.was_saved());  // seen, and may be written still
  EXPECT_TRUE(watch.was_saved());
  EXPECT_FALSE(watch.was_saved());
}

TEST_F(FileWatches, AFileThatIsGoneForAMomentIsNoticedWhenItIsBack) {
  FileWatch watch(path_);
  std::filesystem::remove(path_);
  EXPECT_FALSE(watch.was_saved());
  EXPECT_FALSE(watch.was_saved());
  write("other text");
  (void)watch.was_saved();
  EXPECT_TRUE(watch.was_saved());
}

TEST_F(FileWatches, WithoutAFileThereIsNothing) {
  EXPECT_FALSE(FileWatch().was_saved());
}

}  // namespace
}  // namespace weft::viewer
