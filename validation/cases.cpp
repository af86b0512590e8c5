#include <weft/validation/cases.hpp>

#include <array>

#include <weft/validation/cases/analytic_cases.hpp>
#include <weft/validation/cases/engine_cases.hpp>
#include <weft/validation/cases/scene_cases.hpp>

namespace weft::validation {

std::span<const CaseInfo> all_cases() {
  static constexpr std::array kCases = {
      CaseInfo{"drape_sphere", "The classic cloth falls over a sphere and drapes", &plan_scene,
               &evaluate_scene},
      CaseInfo{"hang", "A cloth swings from two corners: step for step the same equations",
               &plan_scene, &evaluate_scene},
      CaseInfo{"drop_ground", "A cloth slides over the ground and stops", &plan_scene,
               &evaluate_scene},
      CaseInfo{"drop_box", "A cloth falls over the edges of a box", &plan_scene, &evaluate_scene},
      CaseInfo{"ball_on_cloth", "A ball falls on a pinned cloth: both move", &plan_scene,
               &evaluate_scene},
      CaseInfo{"wind_hover", "A wind catches a falling cloth", &plan_scene, &evaluate_scene},
      CaseInfo{"heavy_strip", "A stiff strip bends under its own weight", &plan_scene,
               &evaluate_scene},
      CaseInfo{"oscillator", "Four integrators against their own exact recurrence", nullptr,
               &evaluate_oscillator},
      CaseInfo{"observed_orders", "The error falls with the step as each integrator promises",
               nullptr, &evaluate_observed_orders},
      CaseInfo{"hanging_chain", "Static drop of a chain of masses and springs", nullptr,
               &evaluate_hanging_chain},
      CaseInfo{"plate_rigidity", "A grid of hinges is an isotropic plate", nullptr,
               &evaluate_plate_rigidity},
      CaseInfo{"cantilever", "A heavy strip bends as the elastica", nullptr, &evaluate_cantilever},
      CaseInfo{"engine_cantilever", "One heavy strip in every engine that carries Weft's laws",
               &plan_engine_cantilever, &evaluate_engine_cantilever},
      CaseInfo{"momentum", "A ball and a free cloth keep their momentum together", &plan_momentum,
               &evaluate_momentum},
      CaseInfo{"torsion_beam", "A chain with three-point torsion is a beam", nullptr,
               &evaluate_torsion_beam},
      CaseInfo{"nonlocal_torsion",
               "Ties to far nodes bring back a flipped flap and hold up a sheet's centre", nullptr,
               &evaluate_nonlocal_torsion},
      CaseInfo{"acceleration_damping", "An added inertia: longer periods, longer stable steps",
               nullptr, &evaluate_acceleration_damping},
      CaseInfo{"rotation_damping", "Spin and swirl decay at their rates, and nothing else does",
               nullptr, &evaluate_rotation_damping},
      CaseInfo{"damped_hang", "The three damping laws in Bullet: step for step the same equations",
               &plan_damped_hang, &evaluate_damped_hang},
      CaseInfo{"hover", "A sheet hovers in the wind that carries its weight", nullptr,
               &evaluate_hover},
      CaseInfo{"balloon", "Pressure curve of a balloon of springs, and where it bursts", nullptr,
               &evaluate_balloon},
      CaseInfo{"materials", "Four materials that differ by their damping alone", &plan_materials,
               &evaluate_materials},
      CaseInfo{"sliding_cloth", "A sliding cloth stops where Coulomb's law says",
               &plan_sliding_cloth, &evaluate_sliding_cloth},
      CaseInfo{"explosion", "Explicit Euler explodes, and is reported as data", &plan_explosion,
               &evaluate_explosion},
      CaseInfo{"work_precision",
               "What precision costs: distance to a converged reference against wall time",
               &plan_work_precision, &evaluate_work_precision},
      CaseInfo{"third_opinion", "Blender's cloth on the same springs, drag and sphere",
               &plan_third_opinion, &evaluate_third_opinion},
      CaseInfo{"determinism", "The same bits for any number of threads", &plan_determinism,
               &evaluate_determinism},
  };
  return kCases;
}

}  // namespace weft::validation
