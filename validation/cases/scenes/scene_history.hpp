#pragma once

// Tested by tests/validation/cases/engines/work_precision_test.cpp, tests/apps/command_line_test.sh.

#include <optional>
#include <string>
#include <vector>

#include <weft/scenes/recording/recording.hpp>
#include <weft/validation/run/engine_runs.hpp>

namespace weft::validation {

/// An engine in one precision.
struct EngineChoice {
  std::string engine;
  scenes::StoredPrecision precision;
  [[nodiscard]] std::string title() const;  ///< "bullet_forces float64"
  [[nodiscard]] std::string label(
      const std::string& case_id) const;  ///< "hang_bullet_forces_float64"
};

/// Every engine that takes part in cross-validation; the reference last.
[[nodiscard]] std::vector<EngineChoice> cross_validated_engines(bool with_bullet);

using Frames = std::vector<scenes::SceneState>;

/// A run as the comparison needs it.
struct History {
  EngineChoice engine;
  Frames frames;
  std::optional<scenes::BlowUp> blow_up;
  std::string content_hash;
  std::string failure;  ///< why there are no frames; empty if there are
};

[[nodiscard]] History load_history(const EngineRuns& runs, const std::string& case_id,
                                   const EngineChoice& engine);

}  // namespace weft::validation
