#pragma once

#include <string>
#include <vector>

#include <weft/validation/cases/scenes/scene_metrics.hpp>
#include <weft/validation/cases/support/sabotage.hpp>
#include <weft/validation/metrics/series/tolerance.hpp>

namespace weft::validation {

/// What a number is compared with.
enum class Against {
  kScheme,    ///< the reference with the engine's own step: the same recurrence, or one run alone
  kSolution,  ///< the reference at its finest of three steps (ReferenceLevels)
  kSeeds,     ///< the mean over runs of the reference that start apart by a hair (SeedRuns)
};

/// One number of one engine in one scene, held against a bound.
struct SceneBound {
  EngineChoice engine;
  std::string claim;
  Quantity quantity;
  double begin = 0.0;  ///< [s] frames that are looked at
  double end = 0.0;    ///< [s]
  Tolerance tolerance;
  std::vector<Sabotage> sabotages;  ///< of the run the engine is compared with
  std::string note;                 ///< what to look at when it fails
  Against against = Against::kScheme;
};

/// The bounds of a catalog scene. Every bound was measured; docs/validation.md says how.
[[nodiscard]] std::vector<SceneBound> scene_bounds(const std::string& scene);

}  // namespace weft::validation
