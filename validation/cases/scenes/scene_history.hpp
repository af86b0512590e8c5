#pragma once

// Tested by tests/validation/cases/engines/work_precision_test.cpp, tests/apps/command_line_test.sh.

#include <optional>
#include <string>
#include <vector>

#include <weft/scenes/recording/recording.hpp>
#include <weft/validation/cases/support/case.hpp>
#include <weft/validation/run/engine_runs.hpp>

namespace weft::validation {

/// An engine in one precision, or a recording that stands in for one.
struct EngineChoice {
  std::string engine;
  scenes::StoredPrecision precision;
  std::string judged_as = {};  ///< of a recording: the engine whose bounds hold for it
  [[nodiscard]] const std::string& bounds() const { return judged_as.empty() ? engine : judged_as; }
  [[nodiscard]] std::string title() const;  ///< "bullet_forces float64"
  [[nodiscard]] std::string label(
      const std::string& case_id) const;  ///< "hang_bullet_forces_float64"
};

inline constexpr auto kFloat32 = scenes::StoredPrecision::kFloat32;
inline constexpr auto kFloat64 = scenes::StoredPrecision::kFloat64;
inline const EngineChoice kReference{"reference", kFloat64};

/// Every engine that takes part in cross-validation; the reference last.
[[nodiscard]] std::vector<EngineChoice> cross_validated_engines(bool with_bullet);
/// The recording to judge as one more engine. options.recorded must be set.
[[nodiscard]] EngineChoice recording_choice(const CaseOptions& options);
/// cross_validated_engines(), or the recording to judge and the reference.
[[nodiscard]] std::vector<EngineChoice> judged_engines(const CaseOptions& options);
/// Asks for the engine's run of the scene; a recording is there already and is taken as it is.
void plan_run(const CaseOptions& options, const std::string& id, const EngineChoice& engine,
              const scenes::Scene& scene, EngineRuns& runs);

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
