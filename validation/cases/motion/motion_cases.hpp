#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// A sheet swings from two corners at 100 N/m to 10 MN/m: kinetic energy and the time of its first turn.
void plan_swing(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_swing(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// Falls, impacts and loads beside explicit integration in short steps; momentum and energy by theory.
void plan_impacts(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_impacts(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// At rest no force is left over, and the step has no say.
void plan_rest(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_rest(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

}  // namespace weft::validation
