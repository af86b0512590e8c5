#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// The scene of a case that is one of the catalog's.
[[nodiscard]] std::vector<scenes::Scene> catalog_scene(const CaseInfo&);
/// Cross-validation of a catalog scene: every engine runs it and is compared with the reference.
void plan_scene(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_scene(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// Scenes in which cloth lies on cloth in the steps of a game, by bullet_weft.
void plan_solved_steps(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_solved_steps(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void plan_layers(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_layers(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// Explicit Euler on drape_sphere: must explode, and must be reported as data.
void plan_explosion(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_explosion(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// The same run twice and with 1, 2 and 4 threads: one recording.
void plan_determinism(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_determinism(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// A flat cloth thrown along the ground: the reference must stop where Coulomb's law says; Bullet's engines are
/// measured and shown.
void plan_sliding_cloth(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_sliding_cloth(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// A hung cloth with the three damping laws: Bullet's world must follow the reference.
void plan_damped_hang(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_damped_hang(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// Stored results of another program beside Weft's engines: measured and shown.
void plan_third_opinion(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_third_opinion(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// All rows of the sweep in all their resolutions.
[[nodiscard]] std::vector<scenes::Scene> sweep_scenes(const CaseInfo&);
/// A cloth on ten bodies in three resolutions: every engine beside the reference.
void plan_collision_sweep(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_collision_sweep(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// Every engine with several steps and numbers of iterations, held against a converged reference and the
/// wall time it took.
void plan_work_precision(const CaseInfo&, const CaseOptions&, EngineRuns&);
void evaluate_work_precision(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// The largest stable step over stiffness and added inertia, predicted by the spectrum and tried.
void evaluate_stability_maps(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

}  // namespace weft::validation
