#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <weft/validation/cases/support/reference_levels.hpp>

namespace weft::validation {

/// Where folds may fall either way no step makes one run the right one. What is compared there is a number of the shape,
/// with its mean over runs that start 0.1 mm apart, each with two steps.
struct SeedPlan {
  std::string id;       ///< of the runs' labels
  scenes::Scene scene;  ///< as the engines run it
};

inline constexpr int kNumSeeds = 8;

void plan_seeds(const SeedPlan& plan, EngineRuns& runs);

/// The numbers of all runs in some windows of time.
class SeedRuns {
 public:
  SeedRuns(const SeedPlan& plan, const SceneMetrics& metrics, std::vector<Window> windows,
           const EngineRuns& runs);

  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  /// Over both steps.
  [[nodiscard]] double mean(const Window& window) const;

  struct OwnError {
    double deviation;       ///< of one run
    double standard_error;  ///< of the mean over all runs
    double step_effect;     ///< mean with one step from that with half of it
    [[nodiscard]] double total() const { return 2 * standard_error + step_effect / 2; }
  };
  [[nodiscard]] OwnError discretization_error(const Window& window) const;
  /// The same with another value for the first run.
  [[nodiscard]] OwnError discretization_error(const Window& window, double first) const;

 private:
  [[nodiscard]] std::size_t index_of(const Window& window) const;

  std::vector<Window> windows_;
  std::vector<std::vector<double>>
      values_;  ///< by window: kNumSeeds with the long step, then the short one
};

/// "The mean's discretization error is a tenth of the bound", with a collider half a metre off in one of the runs as what must fail.
[[nodiscard]] CheckResult seeds_check(const SeedRuns& seeds, const SceneMetrics& metrics,
                                      const Window& window, double bound);

}  // namespace weft::validation
