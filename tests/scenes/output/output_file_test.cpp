#include <weft/scenes/output/output_file.hpp>

#include <sys/stat.h>

#include <gmock/gmock.h>

#include <weft/core/error.hpp>

#include "tests/scenes/output/output_samples.hpp"

namespace weft::output {
namespace {

namespace fs = std::filesystem;
using samples::get;
using samples::kPrecious;
using samples::kSample;
using samples::message_of;
using samples::put;
using testing::HasSubstr;

class OutputFileTest : public samples::FolderTest {};

TEST_F(OutputFileTest, ANewFileIsWholeAndAlone) {
  write_file(at("a"), kSample, "sample 1");
  EXPECT_EQ(get(at("a")), "sample 1");
  EXPECT_EQ(num_files(), 1);
}

TEST_F(OutputFileTest, TheSameKindIsReplacedAndAnythingElseIsNot) {
  put(at("a"), "sample 1");
  write_file(at("a"), kSample, "sample 2");
  EXPECT_EQ(get(at("a")), "sample 2");
  for (const char* foreign : {"", "notes", "Sample"}) {
    put(at("b"), foreign);
    EXPECT_THAT(message_of([&] { write_file(at("b"), kSample, "sample 3"); }),
                HasSubstr("b: exists and is not a sample made by Weft"));
    EXPECT_EQ(get(at("b")), foreign);
  }
  EXPECT_EQ(num_files(), 2);
}

TEST_F(OutputFileTest, APreciousKindNeedsForce) {
  put(at("a"), "sample 1");
  EXPECT_THAT(message_of([&] { OutputFile(at("a"), kPrecious); }), HasSubstr("--force"));
  OutputFile(at("a"), kPrecious, true).write("sample 2");
  EXPECT_EQ(get(at("a")), "sample 2");
  put(at("b"), "notes");
  EXPECT_THROW(OutputFile(at("b"), kPrecious, true), InvalidArgument);  // force is no licence
}

TEST_F(OutputFileTest, LinksFoldersAndPipesAreNeitherFollowedNorReplaced) {
  put(at("target"), "sample 1");
  fs::create_symlink("target", at("link"));
  fs::create_symlink("nowhere", at("dangling"));
  fs::create_directory(at("folder"));
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  for (const auto& [name, what] : {std::pair{"link", "a symbolic link"},
                                   {"dangling", "a symbolic link"},
                                   {"folder", "a folder"},
                                   {"pipe", "a pipe"}}) {
    const fs::path place = at(name);
    EXPECT_THAT(message_of([&] { OutputFile(place, kPrecious, true); }), HasSubstr(what));
  }
  EXPECT_THAT(message_of([] { OutputFile("/dev/null", kSample, true); }), HasSubstr("a device"));
  EXPECT_THAT(message_of([&] { OutputFile(folder_ / "", kSample); }), HasSubstr("folder"));
  EXPECT_THAT(message_of([&] { OutputFile(at("no/such"), kSample); }), HasSubstr("no folder"));
  EXPECT_TRUE(fs::is_symlink(at("link")));
  EXPECT_EQ(get(at("target")), "sample 1");
  EXPECT_EQ(num_files(), 5);
}

TEST_F(OutputFileTest, AFileThatAppearsMeanwhileStaysAndTheResultIsKept) {
  const OutputFile output(at("a.txt"), kSample);
  for (const char* appeared : {"notes", "sample of somebody else"}) {
    put(at("a.txt"), appeared);
    EXPECT_THAT(message_of([&] { output.write("sample 1"); }), HasSubstr("a-2.txt"));
    EXPECT_EQ(get(at("a.txt")), appeared);
    EXPECT_EQ(get(at("a-2.txt")), "sample 1");
    fs::remove(at("a-2.txt"));
  }
  put(at("a-2.txt"), "taken");
  EXPECT_THAT(message_of([&] { output.write("sample 1"); }), HasSubstr("a-3.txt"));
  EXPECT_EQ(num_files(), 3);
}

TEST_F(OutputFileTest, AFileThatChangesMeanwhileStays) {
  put(at("a"), "sample 1");
  const OutputFile output(at("a"), kSample);
  put(at("a"), "sample 1, with hours of notes");
  EXPECT_THAT(message_of([&] { output.write("sample 2"); }), HasSubstr("a-2"));
  EXPECT_EQ(get(at("a")), "sample 1, with hours of notes");
  EXPECT_EQ(get(at("a-2")), "sample 2");
  fs::remove(at("a"));
  output.write("sample 3");  // gone: its name is free
  EXPECT_EQ(get(at("a")), "sample 3");
}

}  // namespace
}  // namespace weft::output
