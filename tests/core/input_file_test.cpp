#include <weft/core/input_file.hpp>

#ifndef _WIN32
#include <sys/stat.h>
#endif
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft {
namespace {

using ::testing::HasSubstr;

class InputFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("weft_input_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_ / "scene/below");
    write("secret", "secret");
    write("scene/own", "own");
    write("scene/below/own", "below");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] std::string error_of(const std::string& name, std::uintmax_t max_size = 100) const {
    try {
      return "read: " + read_input_file(folder_ / name, max_size);
    } catch (const InvalidArgument& error) {
      return error.what();
    }
  }
  /// What a scene in the folder "scene" gets under a name.
  [[nodiscard]] std::string named(const std::string& name) const {
    try {
      return files_below(folder_ / "scene")(name).value_or("none");
    } catch (const InvalidArgument& error) {
      return error.what();
    }
  }

  std::filesystem::path folder_;
};

TEST_F(InputFile, IsReadWhole) {
  write("bytes", std::string("a\0b", 3));
  EXPECT_EQ(read_input_file(folder_ / "bytes"), std::string("a\0b", 3));
  write("empty", "");
  EXPECT_EQ(read_input_file(folder_ / "empty"), "");
  EXPECT_EQ(read_input_start(folder_ / "secret", 3), "sec");
  EXPECT_EQ(read_input_start(folder_ / "secret", 30), "secret");
}

TEST_F(InputFile, NamesWhatIsNoFile) {
  EXPECT_EQ(error_of("nowhere"), "no such file");
  EXPECT_EQ(error_of("secret/nowhere"), "no such file");
  EXPECT_EQ(error_of("scene"), "is a directory, expected a file");
}

#ifndef _WIN32
// Without a writer, opening a pipe waits for ever.
TEST_F(InputFile, NeverWaitsForAPipeOrADevice) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_of("pipe"), HasSubstr("expected a regular file"));
  EXPECT_THROW((void)read_input_file("/dev/zero"), InvalidArgument);
  EXPECT_THROW((void)read_input_start("/dev/zero", 10), InvalidArgument);
}
#else
TEST_F(InputFile, NeverReadsADevice) {
  EXPECT_THAT(error_of("nul"), HasSubstr("expected a regular file"));
  EXPECT_THROW((void)read_input_file("NUL"), InvalidArgument);
}

TEST_F(InputFile, ADriveOrAShareIsNotInTheFolder) {
  for (const char* name : {"C:own", "\\own", "/own", "C:/own", "\\\\host\\share\\own"}) {
    EXPECT_THAT(named(name), HasSubstr("is an absolute path")) << name;
  }
  EXPECT_EQ(named("below\\own"), "below");
  EXPECT_THAT(named("below\\..\\..\\secret"), HasSubstr("without '..'"));
}
#endif

TEST_F(InputFile, IsRefusedBeforeItIsReadIfItIsTooLarge) {
  EXPECT_EQ(error_of("secret", 6), "read: secret");
  EXPECT_EQ(error_of("secret", 5), "has 6 bytes, expected at most 5");
  std::filesystem::resize_file(folder_ / "secret", 20'000'000'000);  // no block on the disk
  EXPECT_EQ(error_of("secret"), "has 20000000000 bytes, expected at most 100");
}

TEST_F(InputFile, OtherFilesAreInTheFolderOrBelow) {
  EXPECT_EQ(named("own"), "own");
  EXPECT_EQ(named("./below/own"), "below");
  EXPECT_EQ(named("nowhere"), "none");
  EXPECT_EQ(named(""), "none");
  EXPECT_EQ(named(std::string("own\0.png", 8)), "none");
  EXPECT_THAT(named("../secret"), HasSubstr("without '..'"));
  EXPECT_THAT(named("below/../../secret"), HasSubstr("without '..'"));
  EXPECT_THAT(named((folder_ / "secret").string()), HasSubstr("is an absolute path"));
}

#ifndef _WIN32
TEST_F(InputFile, ALinkDoesNotLeadOut) {
  std::filesystem::create_symlink(folder_ / "secret", folder_ / "scene/link");
  std::filesystem::create_directory_symlink(folder_, folder_ / "scene/up");
  std::filesystem::create_symlink(folder_ / "scene/own", folder_ / "scene/inside");
  EXPECT_THAT(named("link"), HasSubstr("is a link out of the folder"));
  EXPECT_THAT(named("up/secret"), HasSubstr("is a link out of the folder"));
  EXPECT_EQ(named("inside"), "own");
}
#else
// GCC's library makes no links on Windows: tools/windows.sh has made a folder with the same ones, which Wine shows.
TEST_F(InputFile, ALinkDoesNotLeadOut) {
  const char* const folder = std::getenv("WEFT_TEST_LINKS");
  if (!folder) GTEST_SKIP() << "WEFT_TEST_LINKS names no folder with links";
  const FileSource files = files_below(folder);
  EXPECT_THROW((void)files("link"), InvalidArgument);
  EXPECT_THROW((void)files("up/secret"), InvalidArgument);
  EXPECT_EQ(files("inside"), "own");
}
#endif

TEST_F(InputFile, AFileInASubfolderNamesItsOwnNeighbors) {
  const FileSource files = files_beside(files_below(folder_ / "scene"), "below/model");
  EXPECT_EQ(files("own"), "below");
  EXPECT_THROW((void)files("../own"), InvalidArgument);
  EXPECT_THROW((void)files((folder_ / "secret").string()), InvalidArgument);
  EXPECT_FALSE(files_beside({}, "below/model"));
}

TEST_F(InputFile, AllNamedFilesHaveALargestSizeTogether) {
  write("scene/half", "");
  std::filesystem::resize_file(folder_ / "scene/half", kMaxInputSize * 3 / 5);
  const FileSource files = files_below(folder_ / "scene");
  EXPECT_EQ(files("half")->size(), kMaxInputSize * 3 / 5);
  EXPECT_THROW((void)files("half"), InvalidArgument);
}

}  // namespace
}  // namespace weft
