#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include <weft/validation/report/formats/base64.hpp>
#include <weft/validation/report/report.hpp>

#include "tests/validation/report/sample_report.hpp"

namespace weft::validation {
namespace {

using nlohmann::json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Base64, MatchesTheVectorsOfRfc4648) {
  EXPECT_EQ(to_base64(""), "");
  EXPECT_EQ(to_base64("f"), "Zg==");
  EXPECT_EQ(to_base64("fo"), "Zm8=");
  EXPECT_EQ(to_base64("foo"), "Zm9v");
  EXPECT_EQ(to_base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(to_base64("\xFF\xFE\xFD"), "//79");
}

TEST(Json, NamesItsSchemaAndVersion) {
  const json read = json::parse(to_json(Report{}));
  EXPECT_EQ(read["schema"], "weft-report");
  EXPECT_EQ(read["schema_version"], 3);
}

TEST(Json, HoldsEveryFieldOfACheck) {
  const Report report = tests::sample_report();
  const json read = json::parse(to_json(report));
  ASSERT_EQ(read["checks"].size(), report.checks.size());
  for (std::size_t i = 0; i < report.checks.size(); ++i) {
    const CheckResult& check = report.checks[i];
    const json& row = read["checks"][i];
    EXPECT_EQ(row["case"], check.case_id);
    EXPECT_EQ(row["engine"], check.engine);
    EXPECT_EQ(row["claim"], check.claim);
    EXPECT_EQ(row["metric"], check.metric);
    EXPECT_EQ(row["unit"], check.unit);
    EXPECT_EQ(row["formula"], check.formula);
    EXPECT_EQ(row["source"], check.source);
    EXPECT_EQ(row["note"], check.note);
    EXPECT_EQ(row["sabotages"].size(), check.sabotages.size());
    if (std::isfinite(check.measured)) {
      EXPECT_EQ(row["measured"].get<double>(), check.measured);
    }
    ASSERT_EQ(row["tolerance"].is_null(), !check.tolerance.has_value());
    if (!check.tolerance) continue;
    EXPECT_EQ(row["tolerance"]["value"].get<double>(), check.tolerance->value);
    EXPECT_EQ(row["tolerance"]["basis"], std::string(to_string(check.tolerance->basis)));
    EXPECT_EQ(row["tolerance"]["why"], check.tolerance->why);
  }
}

TEST(Json, NumbersReadBackToTheSameBits) {
  const double values[] = {0.1,  1.0 / 3.0,          5e-324, 1.7976931348623157e308,
                           -0.0, 123456789.123456789};
  for (const double value : values) {
    Report report;
    report.checks.resize(1);
    report.checks[0].measured = value;
    const double read = json::parse(to_json(report))["checks"][0]["measured"].get<double>();
    EXPECT_EQ(read, value);
    EXPECT_EQ(std::signbit(read), std::signbit(value));
  }
}

TEST(Json, NumbersThatAreNotFiniteAreWords) {
  Report report;
  report.sections.resize(1);
  report.sections[0].plots = {
      {"p", "x", "y", false, true, {{"s", {1, 2, 3}, {std::nan(""), kInfinity, -kInfinity}}}}};
  const json read = json::parse(to_json(report));
  EXPECT_EQ(read["sections"][0]["plots"][0]["series"][0]["y"],
            json({"NaN", "Infinity", "-Infinity"}));
  EXPECT_EQ(read["sections"][0]["plots"][0]["series"][0]["x"], json({1.0, 2.0, 3.0}));
  EXPECT_EQ(read["sections"][0]["plots"][0]["log_y"], true);
}

TEST(Json, CountsWhatTheVerdictLineSays) {
  const json read = json::parse(to_json(tests::sample_report()));
  EXPECT_EQ(read["passed"], false);
  EXPECT_EQ(read["summary"]["checks_failed"], 2);
  EXPECT_EQ(read["summary"]["checks_not_gated"], 2);
  EXPECT_EQ(
      read["summary"]["sabotages"].get<int>() - read["summary"]["sabotages_detected"].get<int>(),
      1);
}

TEST(Json, HoldsSectionsDeviationsLimitsAndProvenance) {
  const Report report = tests::sample_report();
  const json read = json::parse(to_json(report));
  const json& drape = read["sections"][2];
  EXPECT_EQ(drape["scene_text"], report.sections[2].scene_text);
  EXPECT_EQ(drape["tables"][0]["rows"][1][1], "2.31");
  const json& picture = drape["picture_rows"][1]["pictures"][2];
  EXPECT_EQ(picture["base64"], to_base64(report.sections[2].picture_rows[1].pictures[2].image));
  EXPECT_EQ(picture["mime"], "image/png");
  EXPECT_EQ(picture["file"], "pictures/3-drape_sphere/2-3-bullet_forces_float32.png");
  EXPECT_EQ(read["departures"][0]["reason"], report.deviations[0].reason);
  EXPECT_EQ(read["limits"], json(report.limits));
  EXPECT_EQ(read["provenance"][1]["name"], report.provenance[1].first);
  EXPECT_EQ(read["provenance"][1]["value"], report.provenance[1].second);
}

TEST(Json, KeepsASeriesOnOneLine) {
  Report report;
  report.sections.resize(1);
  report.sections[0].plots = {{"p", "x", "y", false, false, {{"s", {1, 2, 3}, {4, 5, 6}}}}};
  EXPECT_THAT(to_json(report), testing::HasSubstr("\"x\": [1.0, 2.0, 3.0],\n"));
}

TEST(Json, SurvivesTextThatIsNotUtf8) {
  Report report;
  report.title = "bad \xC3( byte";
  EXPECT_EQ(json::parse(to_json(report))["title"], "bad \xEF\xBF\xBD( byte");
}

TEST(Json, IsTheSameTextTwice) {
  EXPECT_EQ(to_json(tests::sample_report()), to_json(tests::sample_report()));
}

}  // namespace
}  // namespace weft::validation
