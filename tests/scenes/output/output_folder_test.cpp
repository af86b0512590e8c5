#include <weft/scenes/output/output_folder.hpp>

#include <gmock/gmock.h>

#include <weft/core/error.hpp>

#include "tests/scenes/output/output_samples.hpp"

namespace weft::output {
namespace {

namespace fs = std::filesystem;
using samples::get;
using samples::kSample;
using samples::message_of;
using samples::put;
using testing::HasSubstr;

class OutputFolderTest : public samples::FolderTest {};

TEST_F(OutputFolderTest, NewEmptyAndEarlierOnesAreFilled) {
  OutputFolder(at("a/b"), "token", kSample).write("deep/er/x", "1");
  OutputFolder(at("a/b/"), "token", kSample).write("deep/er/x", "2");
  EXPECT_EQ(get(at("a/b/deep/er/x")), "2");
  fs::create_directory(at("empty"));
  OutputFolder(at("empty"), "token", kSample).write("x", "3");
  EXPECT_EQ(get(at("empty/x")), "3");
  fs::create_directory(at("without_mark"));
  put(at("without_mark/token"), "sample");
  EXPECT_NO_THROW(OutputFolder(at("without_mark"), "token", kSample));
}

TEST_F(OutputFolderTest, AnotherFolderIsLeftAlone) {
  fs::create_directory(at("mine"));
  put(at("mine/token"), "thesis");
  EXPECT_THAT(message_of([&] { OutputFolder(at("mine"), "token", kSample); }),
              HasSubstr("mine: holds other files"));
  EXPECT_EQ(get(at("mine/token")), "thesis");
  EXPECT_FALSE(fs::exists(at("mine") / kFolderMark));
  put(at("file"), "");
  EXPECT_THROW(OutputFolder(at("file"), "token", kSample), Error);
}

TEST_F(OutputFolderTest, LinksAreNotFollowed) {
  fs::create_directory(at("outside"));
  fs::create_directory_symlink("outside", at("link"));
  EXPECT_THAT(message_of([&] { OutputFolder(at("link"), "token", kSample); }),
              HasSubstr("symbolic link"));
  const OutputFolder folder(at("a"), "token", kSample);
  fs::create_directory_symlink("../outside", at("a/runs"));
  EXPECT_THAT(message_of([&] { folder.write("runs/x", "1"); }), HasSubstr("symbolic link"));
  put(at("outside_file"), "kept");
  fs::create_symlink("../outside_file", at("a/x"));
  EXPECT_THAT(message_of([&] { folder.write("x", "1"); }), HasSubstr("not a plain file"));
  EXPECT_EQ(get(at("outside_file")), "kept");
  EXPECT_TRUE(fs::is_empty(at("outside")));
}

TEST_F(OutputFolderTest, HasOneOwner) {
  const OutputFolder first(at("a"), "token", kSample);
  EXPECT_THAT(message_of([&] { OutputFolder(at("a"), "token", kSample); }),
              HasSubstr("two outputs"));
}

}  // namespace
}  // namespace weft::output
