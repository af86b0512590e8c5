#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <optional>
#include <string>
#include <vector>

#include <weft/validation/cases/engines/seed_runs.hpp>
#include <weft/validation/cases/scenes/scene_gates.hpp>
#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// What the gates of a catalog scene are held against, and how exact that is.
class ReferenceSolution {
 public:
  /// scene: as the engines run it. gates: those of the engines that are judged.
  ReferenceSolution(std::string id, const scenes::Scene& scene, std::vector<SceneGate> gates);

  [[nodiscard]] const std::vector<SceneGate>& gates() const { return gates_; }
  void plan(EngineRuns& runs) const;
  void load(const SceneMetrics& metrics, const EngineRuns& runs);

  /// What a gate bounds. same_step: the reference with the engines' own step.
  [[nodiscard]] double measured(const SceneGate& gate, const SceneMetrics& metrics,
                                const Frames& frames, const Frames& same_step) const;
  /// What the gate is compared with, in words.
  [[nodiscard]] std::string source(const SceneGate& gate) const;

  /// One check for each window of time that a gate looks at: the reference's discretization error is a tenth of the gate.
  [[nodiscard]] std::vector<CheckResult> own_checks(const CaseInfo& info,
                                                    const SceneMetrics& metrics) const;
  /// The numbers of those checks. No rows: no gate is held against a solution.
  [[nodiscard]] Table own_table(const SceneMetrics& metrics) const;

 private:
  struct Served {
    Window window;
    double gate;  ///< the tightest one
  };
  [[nodiscard]] std::vector<Served> served(Against against) const;
  [[nodiscard]] std::vector<Window> windows(Against against) const;
  [[nodiscard]] LevelPlan level_plan() const;

  std::string id_;
  scenes::Scene scene_;
  std::vector<SceneGate> gates_;
  std::optional<ReferenceLevels> levels_;
  std::optional<SeedRuns> seeds_;
};

[[nodiscard]] std::string metric_text(Quantity quantity);

}  // namespace weft::validation
