#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <string>
#include <vector>

#include <weft/validation/cases/engines/collision_scenes.hpp>
#include <weft/validation/cases/support/case.hpp>
#include <weft/validation/cases/support/reference_levels.hpp>

namespace weft::validation {

/// An engine as the sweep runs it.
struct SweepEngine {
  EngineChoice choice;
  int step_factor = 1;  ///< its steps are so many of the scene's

  [[nodiscard]] std::string title() const;
  [[nodiscard]] std::string id(const std::string& run) const;
  /// Slides as Coulomb's law says, and not by a share of the motion per visit.
  [[nodiscard]] bool has_coulomb_friction() const;
};

/// Engines that can run a scene of the sweep, none in a program without Bullet; or the recording to judge alone.
[[nodiscard]] std::vector<SweepEngine> sweep_engines(const CollisionScene& scene,
                                                     const CaseOptions& options);

/// How many nodes along each side a scene is run with.
[[nodiscard]] std::vector<int> sweep_resolutions(const CollisionScene& scene);

inline constexpr double kEarlyEnd = 0.5;   ///< [s]
inline constexpr double kSweepGap = 0.01;  ///< the tightest bound, of the cloth's size [-]

/// One scene of the sweep in one resolution: what is run, and how far runs are from each other.
class Comparison {
 public:
  Comparison(const CaseInfo& info, const CollisionScene& row, int nodes);

  void plan(const CaseOptions& options, EngineRuns& runs) const;
  void load(const CaseOptions& options, const EngineRuns& runs);

  [[nodiscard]] const CollisionScene& row() const { return row_; }
  [[nodiscard]] int nodes() const { return nodes_; }
  [[nodiscard]] const SceneMetrics& metrics() const { return metrics_; }
  [[nodiscard]] const ReferenceLevels& levels() const { return levels_.front(); }
  [[nodiscard]] const Frames& reference() const { return levels().finest(); }
  [[nodiscard]] const std::vector<SweepEngine>& engines() const { return engines_; }
  [[nodiscard]] const std::vector<History>& histories() const { return histories_; }
  /// Runs with the row's mistakes; empty but in the coarsest resolution, and where a recording is judged.
  [[nodiscard]] const Frames& wrong(bool at_rest) const {
    return at_rest ? wrong_late_ : wrong_early_;
  }
  [[nodiscard]] bool is_coarsest() const;

  [[nodiscard]] Window window(bool at_rest) const;
  /// Largest RMS distance in the first half second, or that at rest, over the cloth's size [-].
  [[nodiscard]] double distance(const Frames& a, const Frames& b, bool at_rest) const;
  /// RMS speed of the reference's nodes at the end [m/s].
  [[nodiscard]] double end_speed() const;

 private:
  [[nodiscard]] LevelPlan level_plan() const;
  [[nodiscard]] bool has_wrong_runs(const CaseOptions& options) const {
    return is_coarsest() || options.recorded.has_value();
  }

  const CollisionScene& row_;
  int nodes_;
  std::string id_;
  SceneMetrics metrics_;
  std::vector<ReferenceLevels> levels_;  ///< one, once loaded
  std::vector<SweepEngine> engines_;
  std::vector<History> histories_;  ///< of the engines
  Frames wrong_early_;
  Frames wrong_late_;
};

}  // namespace weft::validation
