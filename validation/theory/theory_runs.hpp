#pragma once

// Tested by tests/validation/theory_test.cpp, tests/apps/command_line_test.sh.

#include <weft/validation/cases/support/case.hpp>
#include <weft/validation/theory/theory_scene.hpp>

namespace weft::validation {

/// An engine with the step that it takes.
struct TheoryEngine {
  EngineChoice choice;
  int steps_per_second = 0;  ///< 0: the scene's own step

  [[nodiscard]] std::string title() const;  ///< "bullet_weft float32, 1/60 s"
};

/// Who is judged: bullet_weft in both precisions with each of kTheoryStepsPerSecond, bullet_forces in both precisions and
/// the reference with the scene's step. engine: only this one; empty: all that the program has.
[[nodiscard]] std::vector<TheoryEngine> theory_engines(bool with_bullet, const std::string& engine);

/// The names of those engines, each once.
[[nodiscard]] std::vector<std::string> theory_engine_names(bool with_bullet);

/// The case's theory scenes with every engine, and each of their sabotages once with the reference.
void plan_theory(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs);
/// A check for every bound of every engine: the engine's number against the theory's.
void judge_theory(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                  Report& report);

/// The check of one bound, from the frames of a run that took steps of time_step [s] and of the bound's sabotages, in their
/// order. A run without all of its frames (it blew up, or did not run) fails.
[[nodiscard]] CheckResult judge_bound(const TheoryBound& bound, double time_step, bool is_complete,
                                      const Frames& frames, const std::vector<Frames>& sabotaged);

}  // namespace weft::validation
