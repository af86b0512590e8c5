#include <weft/validation/theory/theory_runs.hpp>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/validation/cases.hpp>
#include <weft/validation/suite.hpp>

namespace weft::validation {
namespace {

const CaseInfo& case_of(std::string_view id) {
  for (const CaseInfo& info : all_cases()) {
    if (info.id == id) return info;
  }
  throw InvalidArgument("no such case");
}

/// The checks of a case at one point, by the reference alone.
std::vector<CheckResult> own_checks(std::string_view id, const CaseValues& values) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("weft_theory_" + std::to_string(getpid()));
  const EngineRuns runs("weft", folder, 1);
  CaseOptions options;
  options.pictures = false;
  options.values = values;
  Report report;
  const CaseInfo& info = case_of(id);
  info.evaluate(info, options, runs, report);
  std::filesystem::remove_all(folder);
  return report.checks;
}

TEST(TheoryCases, ARelativeErrorHasTheNumbersThatItWasComputedFrom) {
  const std::vector<std::pair<std::string_view, CaseValues>> points = {
      {"hanging_chain", {{"masses", 3}}},
      {"catenary", {{"nodes", 50}}},
      {"cantilever", {{"nodes", 20}}},
      {"cantilever", {{"nodes", 20}, {"tilt", 30}}},
      {"tip_load", {{"nodes", 20}}},
      {"peirce", {{"nodes", 20}}},
      {"frequencies", {{"masses", 4}, {"cells", 4}, {"nodes", 30}}},
      {"balloon", {{"stretch", 0.1}}},
      {"helix", {{"nodes", 40}}},
      {"torsion_beam", {}}};
  for (const auto& [id, values] : points) {
    int shown = 0;
    for (const CheckResult& check : own_checks(id, values)) {
      SCOPED_TRACE(std::string(id) + ": " + check.metric);
      if (check.metric.find("relative error") == std::string::npos) continue;
      ++shown;
      ASSERT_FALSE(check.values.empty());
      for (const ComparedValue& pair : check.values) {
        EXPECT_FALSE(pair.quantity.empty());
        EXPECT_FALSE(pair.unit.empty());
      }
      if (check.values.size() > 1) continue;
      EXPECT_NEAR(check.measured, std::abs(check.values[0].value / check.values[0].expected - 1),
                  1e-12);
    }
    EXPECT_GT(shown + (id == "tip_load" ? 1 : 0), 0) << id;
  }
}

// What "validate buckling --lateral-nodes 60" asks for.
TEST(TheoryCases, BucklingHoldsAtBothEndsOfItsRanges) {
  for (const CaseValues& values :
       {CaseValues{{"lateral-nodes", 60}, {"nodes", 10}},
        CaseValues{{"lateral-nodes", 90}, {"nodes", 13}},
        CaseValues{{"lateral-nodes", 40}, {"width-nodes", 4}, {"nodes", 11}}}) {
    for (const CheckResult& check : own_checks("buckling", values)) {
      SCOPED_TRACE(check.metric);
      EXPECT_EQ(check.verdict, Verdict::kPass)
          << check.measured << " of " << check.tolerance->value;
      for (const SabotageResult& sabotage : check.sabotages) {
        EXPECT_TRUE(sabotage.detected) << sabotage.name << ": " << sabotage.measured;
      }
    }
  }
}

TEST(TheoryScenes, HaveUniqueClaimsFramesForEveryStepAndSabotages) {
  int scenes = 0;
  for (const CaseInfo& info : all_cases()) {
    if (info.theory == nullptr) continue;
    std::set<std::string> ids;
    std::set<std::string> claims;
    for (const TheoryScene& theory : info.theory(info, {})) {
      ++scenes;
      SCOPED_TRACE(std::string(info.id) + " " + theory.id);
      EXPECT_TRUE(ids.insert(theory.id).second);
      const scenes::World& world = theory.scene.world;
      EXPECT_NEAR(world.frame_interval * 30, std::round(world.frame_interval * 30), 1e-9);
      EXPECT_LE(world.time_step, 1.0 / 30 + 1e-12);
      for (const int steps : kTheoryStepsPerSecond) {
        EXPECT_NEAR(world.duration * steps, std::round(world.duration * steps), 1e-6);
      }
      EXPECT_FALSE(theory.bounds.empty());
      for (const TheoryBound& bound : theory.bounds) {
        EXPECT_TRUE(claims.insert(bound.claim).second) << bound.claim;
        EXPECT_FALSE(bound.sabotages.empty()) << bound.claim;
      }
      // The scene is one that its own reader takes.
      EXPECT_NO_THROW(
          (void)scenes::read_scene_text(scenes::write_scene(theory.scene), "theory.toml"));
    }
  }
  EXPECT_GT(scenes, 15);
}

TEST(TheoryRuns, JudgeTheFastSolverInBothPrecisionsAtEveryStep) {
  int fast = 0;
  std::set<std::string> titles;
  for (const TheoryEngine& engine : theory_engines(true, "")) {
    EXPECT_TRUE(titles.insert(engine.title()).second);
    fast += engine.choice.engine == "bullet_weft" ? 1 : 0;
  }
  EXPECT_EQ(fast, 8);
  EXPECT_TRUE(titles.contains("bullet_weft float32, 1/30 s"));
  EXPECT_TRUE(titles.contains("bullet_forces float64"));
  EXPECT_TRUE(titles.contains("reference"));
  EXPECT_EQ(theory_engines(true, "bullet_forces").size(), 2U);
}

TheoryBound gate_of_half() {
  TheoryBound bound;
  bound.claim = "it ends at 2";
  bound.values = [](const Frames& frames) -> std::vector<ComparedValue> {
    return {{"end", frames.back().time, 2.0, "s"}};
  };
  bound.tolerance = [](double h) { return Tolerance{h, Basis::kTruncation, "a step"}; };
  bound.sabotages = {Sabotage{"something"}};
  return bound;
}

Frames frames_until(double time) {
  Frames frames(2);
  frames[1].time = time;
  return frames;
}

TEST(TheoryRuns, ANumberIsHeldAgainstTheTheoryWithTheBoundOfTheStep) {
  const TheoryBound bound = gate_of_half();
  const CheckResult good = judge_bound(bound, 0.1, true, frames_until(2.1), {frames_until(3)});
  EXPECT_EQ(good.verdict, Verdict::kPass);
  EXPECT_NEAR(good.measured, 0.05, 1e-12);
  EXPECT_EQ(good.values[0].expected, 2.0);
  EXPECT_TRUE(good.sabotages[0].detected);
  EXPECT_EQ(judge_bound(bound, 0.01, true, frames_until(2.1), {frames_until(3)}).verdict,
            Verdict::kFail);
}

TEST(TheoryRuns, ARunThatBlewUpFailsAndASabotageThatDidIsNoProof) {
  const TheoryBound bound = gate_of_half();
  EXPECT_EQ(judge_bound(bound, 0.1, false, frames_until(2.0), {frames_until(3)}).verdict,
            Verdict::kFail);
  const double none = std::nan("");
  EXPECT_FALSE(
      judge_bound(bound, 0.1, true, frames_until(2.0), {frames_until(none)}).sabotages[0].detected);
}

std::string refusal(const std::string& id, const CaseValues& values, const std::string& engine) {
  SuiteOptions options;
  options.case_ids = {id};
  options.cases.values = values;
  options.cases.engine = engine;
  try {
    (void)chosen_cases(options);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(TheoryRuns, AnEngineIsTakenWhereTheCaseHasScenesForIt) {
  EXPECT_EQ(refusal("cantilever", {{"gamma", 5}}, "bullet_weft"), "");
  EXPECT_EQ(refusal("oscillator", {}, "bullet_forces"), "");
  EXPECT_NE(refusal("helix", {}, "bullet_weft").find("expected one of: reference"),
            std::string::npos);
  EXPECT_NE(
      refusal("cantilever", {}, "bullet_soft")
          .find("engine 'bullet_soft', expected one of: bullet_weft, bullet_forces, reference"),
      std::string::npos);
}

TEST(TheoryScenes, RefuseAValueThatOnlyTheReferenceTakes) {
  CaseOptions options;
  options.engine = "bullet_weft";
  options.values = {{"angle", 17.0}};
  const CaseInfo& info = case_of("cantilever");
  EXPECT_THROW((void)info.theory(info, options), InvalidArgument);
  options.values = {{"gamma", 3.0}};
  EXPECT_EQ(info.theory(info, options).size(), 1U);
}

}  // namespace
}  // namespace weft::validation
