#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/validation/report/formats/xml_text.hpp>
#include <weft/validation/report/report.hpp>

#include "tests/validation/report/sample_report.hpp"

namespace weft::validation {
namespace {

using testing::HasSubstr;
using testing::Not;

int occurrences(const std::string& text, const std::string& word) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    ++count;
  return count;
}

TEST(XmlText, EscapesMarkup) {
  EXPECT_EQ(xml_text("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
}

TEST(XmlText, KeepsUtf8AndLineBreaks) {
  EXPECT_EQ(xml_text("α\n\t→ 𝛼"), "α&#10;&#9;→ 𝛼");
}

TEST(XmlText, ReplacesWhatXmlCannotHold) {
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ(xml_text(std::string_view("\0", 1)), replaced);
  EXPECT_EQ(xml_text("\x1B[0m"), replaced + "[0m");
  EXPECT_EQ(xml_text("\xEF\xBF\xBF"), replaced + replaced + replaced);  // U+FFFF
  EXPECT_EQ(xml_text("\xED\xA0\x80"), replaced + replaced + replaced);  // a surrogate
  EXPECT_EQ(xml_text("\xC0\xAF"), replaced + replaced);                 // an overlong slash
  EXPECT_EQ(xml_text("\xE2\x82"), replaced + replaced);                 // cut off
}

TEST(Junit, HasOneTestPerCheckAndPerSabotage) {
  const Report report = tests::sample_report();
  std::size_t expected = report.checks.size();
  for (const CheckResult& check : report.checks) expected += check.sabotages.size();
  const std::string xml = to_junit(report);
  EXPECT_EQ(occurrences(xml, "<testcase "), static_cast<int>(expected));
  EXPECT_EQ(occurrences(xml, "<failure "), 3);  // two checks and a sabotage nobody noticed
  EXPECT_EQ(occurrences(xml, "<skipped "), 2);
  EXPECT_THAT(xml, HasSubstr("tests=\"" + std::to_string(expected) +
                             "\" failures=\"3\" errors=\"0\" skipped=\"2\""));
}

TEST(Junit, FailureSaysMeasuredAllowedRatioBasisAndNote) {
  const std::string xml = to_junit(tests::sample_report());
  EXPECT_THAT(
      xml,
      HasSubstr(
          "measured 0.031, allowed 0.01 (ratio 3.1), basis statistical: 3 sigma over 20 seeds"));
  EXPECT_THAT(xml, HasSubstr("note: Energy plot of hang"));
  EXPECT_THAT(xml, HasSubstr("not noticed: measured 0.004, allowed 0.01 (ratio 0.4)"));
  EXPECT_THAT(xml, HasSubstr("measured nan m, allowed 10 m (ratio nan)"));
}

TEST(Junit, HostileTextStaysText) {
  const std::string xml = to_junit(tests::sample_report());
  EXPECT_THAT(xml, Not(HasSubstr("<script")));
  EXPECT_THAT(xml, HasSubstr("&lt;script&gt;"));
}

TEST(Junit, EmptyReportIsStillADocument) {
  EXPECT_THAT(to_junit(Report{}), HasSubstr("<testsuites name=\"\" tests=\"0\""));
}

}  // namespace
}  // namespace weft::validation
