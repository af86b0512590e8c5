#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <string>
#include <vector>

#include <weft/validation/cases/scenes/scene_metrics.hpp>
#include <weft/validation/metrics/series/convergence.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// What an engine is held against where a solution is meant and not a scheme: velocity Verlet at three steps.
struct LevelPlan {
  std::string id;       ///< of the runs' labels
  scenes::Scene scene;  ///< as the engines run it, but only as long as it is needed
  int finest_division =
      4;  ///< the shortest step is the scene's over this; the others are 2 and 4 times that
};

void plan_levels(const LevelPlan& plan, EngineRuns& runs);

/// A number of a run, and when it is looked at.
struct Window {
  Quantity quantity;
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
};

/// The three runs, and what they say of the finest one.
class ReferenceLevels {
 public:
  ReferenceLevels(const LevelPlan& plan, const EngineRuns& runs);

  [[nodiscard]] const Frames& finest() const { return levels_[2]; }
  /// 4h, 2h, h.
  [[nodiscard]] const std::vector<Frames>& all() const { return levels_; }
  [[nodiscard]] double finest_step() const { return finest_step_; }  ///< [s]
  /// The order of velocity Verlet in this scene: 2 of smooth motion, from 1 on with contact.
  [[nodiscard]] const MethodOrder& order() const { return order_; }

  struct OwnError {
    double coarse;  ///< levels 4h and 2h apart, in the quantity's unit
    double fine;    ///< levels 2h and h apart
    NormStudy study;
  };
  [[nodiscard]] OwnError discretization_error(const SceneMetrics& metrics,
                                              const Window& window) const;
  /// The same with another run in place of the finest one.
  [[nodiscard]] OwnError discretization_error(const SceneMetrics& metrics, const Window& window,
                                              const Frames& finest) const;

 private:
  std::vector<Frames> levels_;  ///< 4h, 2h, h
  double finest_step_;
  MethodOrder order_;
};

/// A share of a bound that the reference's discretization error may take [-].
inline constexpr double kOwnShare = 0.1;

/// "The reference's discretization error is a tenth of the bound", with steps of 1/100 s in place of the finest ones as what must fail.
/// bound: in the quantity's unit. is_sabotaged: no for rows that would only repeat it.
[[nodiscard]] CheckResult discretization_error_check(const ReferenceLevels& levels,
                                                     const SceneMetrics& metrics,
                                                     const std::vector<Window>& windows,
                                                     double bound, bool is_sabotaged = true);

/// Columns and cells of what the report says of it.
[[nodiscard]] std::vector<std::string> own_error_columns();
[[nodiscard]] std::vector<std::string> own_error_cells(const ReferenceLevels& levels,
                                                       const SceneMetrics& metrics,
                                                       const Window& window, double bound);

}  // namespace weft::validation
