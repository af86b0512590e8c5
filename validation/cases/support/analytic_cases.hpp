#pragma once

// Tested by tests/validation/theory_test.cpp, tests/validation/cases/support/parameters_test.cpp.

#include <weft/validation/cases/support/case.hpp>

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

void evaluate_spring_pendulum(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_catenary(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_frequencies(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_invariances(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_energy_ledger(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_spinning_dumbbell(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_lattice_moduli(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_tip_load(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_peirce(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_buckling(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_helix(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_capstan(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_overhang(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_stick_slip(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);
void evaluate_contact_balance(const CaseInfo&, const CaseOptions&, const EngineRuns&, Report&);

/// What can be asked for on the command line.
[[nodiscard]] std::span<const CaseParameter> spring_pendulum_parameters();
[[nodiscard]] std::span<const CaseParameter> catenary_parameters();
[[nodiscard]] std::span<const CaseParameter> frequencies_parameters();
[[nodiscard]] std::span<const CaseParameter> lattice_moduli_parameters();
[[nodiscard]] std::span<const CaseParameter> tip_load_parameters();
[[nodiscard]] std::span<const CaseParameter> peirce_parameters();
[[nodiscard]] std::span<const CaseParameter> buckling_parameters();
[[nodiscard]] std::span<const CaseParameter> cantilever_parameters();
[[nodiscard]] std::span<const CaseParameter> helix_parameters();
[[nodiscard]] std::span<const CaseParameter> capstan_parameters();
[[nodiscard]] std::span<const CaseParameter> overhang_parameters();
[[nodiscard]] std::span<const CaseParameter> stick_slip_parameters();
[[nodiscard]] std::span<const CaseParameter> hanging_chain_parameters();
[[nodiscard]] std::span<const CaseParameter> oscillator_parameters();
[[nodiscard]] std::span<const CaseParameter> balloon_parameters();

}  // namespace weft::validation
