#pragma once

#include <weft/validation/cases/case.hpp>

namespace weft::validation {

/// Cases with a closed form, evaluated in this process with the reference solver.
void evaluate_oscillator(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_observed_orders(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_hanging_chain(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_plate_rigidity(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_cantilever(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_torsion_beam(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_nonlocal_torsion(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

void evaluate_acceleration_damping(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_rotation_damping(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_hover(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_balloon(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

}  // namespace weft::validation
