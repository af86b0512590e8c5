#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <weft/core/error.hpp>
#include <weft/validation/report/picture_path.hpp>
#include <weft/validation/report/write.hpp>

#include "tests/validation/report/sample_report.hpp"

namespace weft::validation {
namespace {

namespace fs = std::filesystem;

class WriteReport : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              (std::string("weft_report_") + info->name() + std::to_string(::getpid()));
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }

  fs::path folder_;
};

TEST_F(WriteReport, WritesThePageItsTwinsAndThePictures) {
  const Report report = tests::sample_report();
  write_report(report, folder_ / "deep" / "er");
  const fs::path out = folder_ / "deep" / "er";
  EXPECT_EQ(read(out / "index.html"), to_html(report));
  EXPECT_EQ(read(out / "report.json"), to_json(report));
  EXPECT_EQ(read(out / "junit.xml"), to_junit(report));
  EXPECT_EQ(read(out / picture_path(report, 2, 1, 3)),
            report.sections[2].picture_rows[1].pictures[3].image);
}

TEST_F(WriteReport, ReplacesAnOlderReportAndLeavesNoTemporaryFile) {
  write_report(tests::sample_report(), folder_);
  write_report(tests::passing_report(), folder_);
  EXPECT_EQ(read(folder_ / "report.json"), to_json(tests::passing_report()));
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
}

TEST_F(WriteReport, TablesAreCsvWithQuotesWhereNeeded) {
  Report report;
  report.sections = {
      {"drape", "", {}, {}, {{"At the end", {"engine", "a, b"}, {{"x \"y\"", "1.5"}}}}, ""}};
  write_report(report, folder_);
  EXPECT_EQ(read(folder_ / "tables/1-drape/1-at_the_end.csv"),
            "engine,\"a, b\"\n\"x \"\"y\"\"\",1.5\n");
}

TEST_F(WriteReport, NamesThePathItCannotWrite) {
  fs::create_directories(folder_ / "report.json");  // a folder stands where the file must go
  try {
    write_report(tests::passing_report(), folder_);
    FAIL() << "expected an Error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr((folder_ / "report.json").string()));
  }
  EXPECT_FALSE(fs::exists(folder_ / "index.html"));
}

TEST_F(WriteReport, NamesTheFolderItCannotMake) {
  std::ofstream(folder_) << "a file";
  EXPECT_THROW(write_report(Report{}, folder_ / "x"), Error);
}

TEST_F(WriteReport, PageIsRenderedAgainFromTheJsonAlone) {
  const Report report = tests::sample_report();
  write_report(report, folder_);
  std::ofstream(folder_ / "index.html") << "an older page";
  fs::remove(folder_ / "junit.xml");
  render_report(folder_);
  EXPECT_EQ(read(folder_ / "index.html"), to_html(report));
  EXPECT_FALSE(fs::exists(folder_ / "junit.xml"));
}

TEST_F(WriteReport, RenderingNamesTheFileThatIsNoReport) {
  fs::create_directories(folder_);
  const auto message = [&] {
    try {
      render_report(folder_);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message(), testing::HasSubstr((folder_ / "report.json").string()));
  std::ofstream(folder_ / "report.json") << "{\"schema\": \"weft-report\", \"schema_version\": 99}";
  EXPECT_THAT(message(), testing::HasSubstr("schema_version is 99, expected 3"));
  std::ofstream(folder_ / "report.json") << "[1, 2";
  EXPECT_THAT(message(), testing::HasSubstr("is not a report"));
  EXPECT_FALSE(fs::exists(folder_ / "index.html"));
}

TEST(PicturePath, StaysInsideTheFolderAndIsUnique) {
  Report report;
  report.sections = {{"../../etc",
                      "",
                      {{"", {{"../a b/Ä", "", ""}, {"../a b/Ä", "", ""}, {"", "", ""}}}},
                      {},
                      {},
                      ""}};
  EXPECT_EQ(picture_path(report, 0, 0, 0), "pictures/1-etc/1-1-a_b.png");
  EXPECT_EQ(picture_path(report, 0, 0, 1), "pictures/1-etc/1-2-a_b.png");
  EXPECT_EQ(picture_path(report, 0, 0, 2), "pictures/1-etc/1-3-untitled.png");
}

TEST(PicturePath, EndsAsTheBytesOfThePictureAre) {
  Report report;
  report.sections = {{"a", "", {{"", {{"b", "", "\xff\xd8\xff\xe0"}}}}, {}, {}, ""}};
  EXPECT_EQ(picture_path(report, 0, 0, 0), "pictures/1-a/1-1-b.jpg");
  EXPECT_STREQ(picture_type(report.sections[0].picture_rows[0].pictures[0].image).mime,
               "image/jpeg");
}

}  // namespace
}  // namespace weft::validation
