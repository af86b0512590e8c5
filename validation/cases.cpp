#include <weft/validation/cases.hpp>

#include <array>

#include <weft/validation/cases/analytic_cases.hpp>
#include <weft/validation/cases/engine_cases.hpp>
#include <weft/validation/cases/scene_cases.hpp>

namespace weft::validation {

namespace {

const std::array kCases = {
    CaseInfo{"drape_sphere", "The classic cloth falls over a sphere and drapes", &plan_scene,
             &evaluate_scene, Tier::kNightly},
    CaseInfo{"hang", "A cloth swings from two corners: step for step the same equations",
             &plan_scene, &evaluate_scene},
    CaseInfo{"drop_ground", "A cloth slides over the ground and stops", &plan_scene,
             &evaluate_scene, Tier::kNightly},
    CaseInfo{"drop_box", "A cloth falls over the edges of a box", &plan_scene, &evaluate_scene,
             Tier::kNightly},
    CaseInfo{"ball_on_cloth", "A ball falls on a pinned cloth: both move", &plan_scene,
             &evaluate_scene, Tier::kNightly},
    CaseInfo{"wind_hover", "A wind catches a falling cloth", &plan_scene, &evaluate_scene,
             Tier::kNightly},
    CaseInfo{"heavy_strip", "A stiff strip bends under its own weight", &plan_scene,
             &evaluate_scene, Tier::kNightly},
    CaseInfo{"oscillator", "Eight integrators against their own exact recurrences", nullptr,
             &evaluate_oscillator, Tier::kCommit, oscillator_parameters()},
    CaseInfo{"observed_orders", "The error falls with the step as each integrator promises",
             nullptr, &evaluate_observed_orders},
    CaseInfo{"hanging_chain", "Static drop of a chain of masses and springs", nullptr,
             &evaluate_hanging_chain, Tier::kCommit, hanging_chain_parameters()},
    CaseInfo{"spring_pendulum", "A pendulum on a spring follows its way", nullptr,
             &evaluate_spring_pendulum, Tier::kCommit, spring_pendulum_parameters()},
    CaseInfo{"catenary", "A chain between two points hangs as the catenary", nullptr,
             &evaluate_catenary, Tier::kCommit, catenary_parameters()},
    CaseInfo{"frequencies", "Chains, strings, membranes and strips vibrate as theory says", nullptr,
             &evaluate_frequencies, Tier::kCommit, frequencies_parameters()},
    CaseInfo{"invariances", "Nothing depends on observer, direction, units, order or mirror",
             nullptr, &evaluate_invariances},
    CaseInfo{"energy_ledger", "Energy, momentum and angular momentum are accounted for", nullptr,
             &evaluate_energy_ledger},
    CaseInfo{"lattice_moduli", "A lattice of springs is a sheet of known moduli", nullptr,
             &evaluate_lattice_moduli, Tier::kCommit, lattice_moduli_parameters()},
    CaseInfo{"plate_rigidity", "A grid of hinges is an isotropic plate", nullptr,
             &evaluate_plate_rigidity},
    CaseInfo{"cantilever", "A heavy strip bends as the elastica", nullptr, &evaluate_cantilever,
             Tier::kCommit, cantilever_parameters()},
    CaseInfo{"tip_load", "A strip with a weight at its tip bends as the elastica", nullptr,
             &evaluate_tip_load, Tier::kCommit, tip_load_parameters()},
    CaseInfo{"peirce", "A virtual bending test recovers the rigidity", nullptr, &evaluate_peirce,
             Tier::kCommit, peirce_parameters()},
    CaseInfo{"buckling", "Heavy strips fall over and tip sideways at their critical loads", nullptr,
             &evaluate_buckling, Tier::kCommit, buckling_parameters()},
    CaseInfo{"engine_cantilever", "One heavy strip in every engine that carries Weft's laws",
             &plan_engine_cantilever, &evaluate_engine_cantilever},
    CaseInfo{"momentum", "A ball and a free cloth keep their momentum together", &plan_momentum,
             &evaluate_momentum},
    CaseInfo{"torsion_beam", "A chain with three-point torsion is a beam", nullptr,
             &evaluate_torsion_beam},
    CaseInfo{"helix", "A rod with three-point torsion is Love's helix, and a ring", nullptr,
             &evaluate_helix, Tier::kCommit, helix_parameters()},
    CaseInfo{"nonlocal_torsion",
             "Ties to far nodes bring back a flipped flap and hold up a sheet's centre", nullptr,
             &evaluate_nonlocal_torsion},
    CaseInfo{"acceleration_damping", "An added inertia: longer periods, longer stable steps",
             nullptr, &evaluate_acceleration_damping},
    CaseInfo{"rotation_damping", "Spin and swirl decay at their rates, and nothing else does",
             nullptr, &evaluate_rotation_damping},
    CaseInfo{"spinning_dumbbell", "Internal damping does not feel a spinning dumbbell", nullptr,
             &evaluate_spinning_dumbbell},
    CaseInfo{"damped_hang", "The three damping laws in Bullet: step for step the same equations",
             &plan_damped_hang, &evaluate_damped_hang},
    CaseInfo{"hover", "A sheet hovers in the wind that carries its weight", nullptr,
             &evaluate_hover},
    CaseInfo{"balloon", "Pressure curve of a balloon of springs, and where it bursts", nullptr,
             &evaluate_balloon, Tier::kCommit, balloon_parameters()},
    CaseInfo{"materials", "Four materials that differ by their damping alone", &plan_materials,
             &evaluate_materials, Tier::kNightly},
    CaseInfo{"contact_balance", "A cloth falls, is carried, and does not pass through", nullptr,
             &evaluate_contact_balance},
    CaseInfo{"capstan", "A chain round a body holds by the friction of its turns", nullptr,
             &evaluate_capstan, Tier::kCommit, capstan_parameters()},
    CaseInfo{"stick_slip", "A pressed strip's tip sticks, then slips", nullptr,
             &evaluate_stick_slip, Tier::kCommit, stick_slip_parameters()},
    CaseInfo{"incline", "Cloths on a slope stick and slide as Coulomb's law says", &plan_incline,
             &evaluate_incline, Tier::kNightly},
    CaseInfo{"stiffness_map", "One link of Bullet's is as stiff as asked for, a chain is not",
             &plan_stiffness_map, &evaluate_stiffness_map, Tier::kNightly},
    CaseInfo{"sliding_cloth", "A sliding cloth stops where Coulomb's law says", &plan_sliding_cloth,
             &evaluate_sliding_cloth},
    CaseInfo{"collision_sweep", "A cloth comes to rest on ten bodies, in three resolutions",
             &plan_collision_sweep, &evaluate_collision_sweep, Tier::kNightly},
    CaseInfo{"cusick", "Discs of cloth drape over a smaller disc, eight times each", nullptr,
             &evaluate_cusick, Tier::kNightly},
    CaseInfo{"explosion", "Explicit Euler explodes, and is reported as data", &plan_explosion,
             &evaluate_explosion},
    CaseInfo{"work_precision",
             "What precision costs: distance to a converged reference against time",
             &plan_work_precision, &evaluate_work_precision, Tier::kNightly},
    CaseInfo{"third_opinion", "Blender's cloth on the same springs, drag and sphere",
             &plan_third_opinion, &evaluate_third_opinion},
    CaseInfo{"determinism", "The same bits for any number of threads", &plan_determinism,
             &evaluate_determinism},
};

}  // namespace

std::span<const CaseInfo> all_cases() {
  return kCases;
}

}  // namespace weft::validation
