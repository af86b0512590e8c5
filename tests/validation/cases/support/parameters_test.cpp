#include <weft/validation/cases/support/parameters.hpp>

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/validation/cases.hpp>
#include <weft/validation/suite.hpp>

namespace weft::validation {
namespace {

SuiteOptions asking(const std::string& id, const CaseValues& values,
                    const std::string& engine = "") {
  SuiteOptions options;
  options.case_ids = {id};
  options.cases.values = values;
  options.cases.engine = engine;
  return options;
}

std::string refusal(const SuiteOptions& options) {
  try {
    (void)chosen_cases(options);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(Parameters, EveryDefaultIsInItsRange) {
  for (const CaseInfo& info : all_cases()) {
    std::set<std::string_view> names;
    for (const CaseParameter& parameter : info.parameters) {
      EXPECT_TRUE(names.insert(parameter.name).second) << info.id << ' ' << parameter.name;
      EXPECT_LT(parameter.minimum, parameter.maximum) << info.id << ' ' << parameter.name;
      EXPECT_FALSE(parameter.unit.empty()) << info.id << ' ' << parameter.name;
      if (!parameter.default_value) continue;
      EXPECT_EQ(refusal(asking(std::string(info.id),
                               {{std::string(parameter.name), *parameter.default_value}})),
                "")
          << info.id << ' ' << parameter.name;
    }
  }
}

TEST(Parameters, AValueInRangeIsTaken) {
  EXPECT_EQ(
      refusal(asking("cantilever", {{"gamma", 3.7}, {"nodes", 60}, {"angle", 17}}, "reference")),
      "");
}

TEST(Parameters, WhatDoesNotFitIsRefusedWithWhatWasExpected) {
  EXPECT_NE(
      refusal(asking("cantilever", {{"gamma", 900}})).find("gamma = 900 [1], expected 0.05 to 500"),
      std::string::npos);
  EXPECT_NE(refusal(asking("cantilever", {{"nodes", 20.5}})).find("a whole number"),
            std::string::npos);
  EXPECT_NE(refusal(asking("cantilever", {{"stiffness", 1}})).find("no parameter 'stiffness'"),
            std::string::npos);
  EXPECT_NE(refusal(asking("hover", {{"gamma", 1}})).find("none"), std::string::npos);
  EXPECT_NE(refusal(asking("cantilever", {{"gamma", 1}}, "bullet_soft")).find("reference"),
            std::string::npos);
  EXPECT_NE(refusal(asking("no_such_case", {})).find("is unknown"), std::string::npos);
}

TEST(Parameters, ValuesAreForOneCase) {
  SuiteOptions two = asking("cantilever", {{"gamma", 1}});
  two.case_ids.push_back("catenary");
  EXPECT_NE(refusal(two).find("one case"), std::string::npos);
  SuiteOptions all = asking("cantilever", {{"gamma", 1}});
  all.case_ids.clear();
  EXPECT_NE(refusal(all).find("one case"), std::string::npos);
}

TEST(Tiers, QuickIsAPartOfAll) {
  SuiteOptions options;
  const std::size_t all = chosen_cases(options).size();
  options.quick = true;
  const auto quick = chosen_cases(options);
  EXPECT_LT(quick.size(), all);
  EXPECT_GT(quick.size(), 10U);
  EXPECT_TRUE(std::all_of(quick.begin(), quick.end(),
                          [](const CaseInfo* info) { return info->tier == Tier::kCommit; }));
}

/// A case at one point: every check of it passes and notices its mistakes.
void expect_sound(const std::string& id, const CaseValues& values) {
  const SuiteOptions options = asking(id, values);
  const CaseInfo& info = *chosen_cases(options).at(0);
  const EngineRuns no_runs("", testing::TempDir(), 1);
  Report report;
  info.evaluate(info, options.cases, no_runs, report);
  EXPECT_FALSE(report.checks.empty()) << id;
  for (const CheckResult& check : report.checks) {
    EXPECT_NE(check.verdict, Verdict::kFail) << id << ": " << check.claim << ' ' << check.measured;
    for (const SabotageResult& sabotage : check.sabotages) {
      EXPECT_TRUE(sabotage.detected) << id << ": " << sabotage.name << ' ' << sabotage.measured;
    }
  }
}

TEST(Points, OffTheTableHoldToo) {
  expect_sound("cantilever", {{"gamma", 3.7}, {"nodes", 40}, {"angle", 17}});
  expect_sound("tip_load", {{"load", 1.7}});
  expect_sound("hanging_chain", {{"masses", 7}, {"mass", 0.03}, {"stiffness", 450}});
  expect_sound("catenary", {{"length", 1.37}, {"stiffness", 55}});
  expect_sound("helix", {{"pitch", 43}, {"natural-curvature", 0.3}});
  expect_sound("lattice_moduli", {{"leg", 77}, {"diagonal", 19}});
  expect_sound("capstan", {{"mu", 0.23}, {"nodes", 9}, {"wrap", 130}});
  expect_sound("overhang", {{"mu", 0.37}, {"nodes", 6}, {"length", 7}});
}

}  // namespace
}  // namespace weft::validation
