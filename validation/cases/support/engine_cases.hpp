#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// The scene heavy_strip in every engine that carries Weft's laws: one H / W.
void plan_engine_cantilever(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_engine_cantilever(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// ball_on_cloth without pins and without gravity: what one gains the other loses.
void plan_momentum(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_momentum(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// The four materials of de Joya 2011: in which order they come down, and what weak damping leaves.
void plan_materials(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_materials(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// Cloths on a slope, 20 x 20 frictions and angles: the reference is gated, Bullet's worlds beside it.
void plan_incline(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_incline(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// The drape test after Cusick, eight times for each fabric, with the reference.
void evaluate_cusick(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// Ropes of Bullet's links: one spring is gated, chains are mapped.
void plan_stiffness_map(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_stiffness_map(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

}  // namespace weft::validation
