#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <optional>
#include <string>
#include <vector>

#include <weft/validation/cases/engines/seed_runs.hpp>
#include <weft/validation/cases/scenes/scene_bounds.hpp>
#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// The solution that the bounds of a catalog scene are measured from, with its discretization error.
class ReferenceSolution {
 public:
  /// scene: as the engines run it. bounds: those of the engines that are judged.
  ReferenceSolution(std::string id, const scenes::Scene& scene, std::vector<SceneBound> bounds);

  [[nodiscard]] const std::vector<SceneBound>& bounds() const { return bounds_; }
  void plan(EngineRuns& runs) const;
  void load(const SceneMetrics& metrics, const EngineRuns& runs);

  /// What a bound bounds. same_step: the reference with the engines' own step.
  [[nodiscard]] double measured(const SceneBound& bound, const SceneMetrics& metrics,
                                const Frames& frames, const Frames& same_step) const;
  /// What the bound is compared with, in words.
  [[nodiscard]] std::string source(const SceneBound& bound) const;

  /// One check for each window of time that a bound looks at: the reference's discretization error is a tenth of the bound.
  [[nodiscard]] std::vector<CheckResult> own_checks(const CaseInfo& info,
                                                    const SceneMetrics& metrics) const;
  /// The numbers of those checks. No rows: no bound is held against a solution.
  [[nodiscard]] Table own_table(const SceneMetrics& metrics) const;

 private:
  struct Served {
    Window window;
    double bound;  ///< the tightest one
  };
  [[nodiscard]] std::vector<Served> served(Against against) const;
  [[nodiscard]] std::vector<Window> windows(Against against) const;
  [[nodiscard]] LevelPlan level_plan() const;

  std::string id_;
  scenes::Scene scene_;
  std::vector<SceneBound> bounds_;
  std::optional<ReferenceLevels> levels_;
  std::optional<SeedRuns> seeds_;
};

[[nodiscard]] std::string metric_text(Quantity quantity);

}  // namespace weft::validation
