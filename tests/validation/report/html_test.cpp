#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <weft/validation/report/page.hpp>
#include <weft/validation/report/report.hpp>

#include "tests/validation/report/sample_report.hpp"

namespace weft::validation {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kOpen = "<script type=\"application/json\" id=\"weft-report\">";

// What a browser takes as the data: everything up to the first end tag.
std::string data_of(const std::string& html) {
  const std::size_t start = html.find(kOpen);
  if (start == std::string::npos) return "";
  const std::size_t from = start + kOpen.size();
  return html.substr(from, html.find("</script", from) - from);
}

TEST(Page, IsOneFileWithASlot) {
  const std::string page(page_template());
  EXPECT_THAT(page, HasSubstr(kOpen + "__WEFT_REPORT_JSON__</script>"));
  EXPECT_THAT(page, Not(HasSubstr("<script src")));
  EXPECT_THAT(page, Not(HasSubstr("type=\"module\"")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(Html, HoldsTheSameDataAsTheJsonFile) {
  const Report report = tests::sample_report();
  EXPECT_EQ(nlohmann::json::parse(data_of(to_html(report))),
            nlohmann::json::parse(to_json(report)));
}

TEST(Html, HostileTextCannotEndTheDataOrOpenAComment) {
  const std::string html = to_html(tests::sample_report());
  EXPECT_THAT(html, Not(HasSubstr("<script>window.hacked")));
  EXPECT_THAT(data_of(html), Not(HasSubstr("<")));
}

TEST(Html, DataThatNamesTheSlotIsLeftAlone) {
  Report report;
  report.title = "__WEFT_REPORT_JSON__";
  EXPECT_EQ(nlohmann::json::parse(data_of(to_html(report)))["title"], "__WEFT_REPORT_JSON__");
}

}  // namespace
}  // namespace weft::validation
