#pragma once

#include <weft/validation/cases/case.hpp>

namespace weft::validation {

/// Cross-validation of a catalog scene: every engine runs it and is compared with the reference.
void plan_scene(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_scene(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// Explicit Euler on drape_sphere: must explode, and must be reported as data.
void plan_explosion(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_explosion(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// The same run twice and with 1, 2 and 4 threads: one recording.
void plan_determinism(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_determinism(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

}  // namespace weft::validation
