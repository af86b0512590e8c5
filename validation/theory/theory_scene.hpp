#pragma once

// Tested by tests/validation/theory_test.cpp.

#include <functional>
#include <string>
#include <vector>

#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/sabotage.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// One number of a scene that a theory knows, whatever the engine and its step.
struct TheoryBound {
  std::string
      claim;  ///< unique within the case, with what the engine is told: "a chain of 10 masses hangs as theory says"
  std::string metric;
  std::string formula;
  std::string source;
  /// From the frames of a whole run. The relative error of the first one is gated; others are shown beside it.
  std::function<std::vector<ComparedValue>(const Frames&)> values;
  /// The tolerance of that relative error, for an engine that takes steps of this length [s].
  std::function<Tolerance(double time_step)> tolerance;
  std::vector<Sabotage>
      sabotages;  ///< of the scene, run by the reference: each must break the bound
};

/// A scene with a theory, as every engine runs it.
struct TheoryScene {
  std::string id;  ///< unique within the case, for labels: "chain_10"
  /// Its time step is that of engines whose springs act explicitly; frames lie a whole number of 1/30 s apart, so that
  /// every step of kTheoryStepsPerSecond meets them.
  scenes::Scene scene;
  std::vector<TheoryBound> bounds;
  /// Its springs are too stiff for explicit steps of any use: bullet_weft alone runs it. Its sabotages, which the reference runs,
  /// have softer ones.
  bool is_stiff = false;
};

/// Steps of bullet_weft, 1/s.
inline constexpr int kTheoryStepsPerSecond[] = {30, 60, 120, 240};

}  // namespace weft::validation
