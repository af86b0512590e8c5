#pragma once

// Tested by tests/bridge/implicit/step_error_test.cpp.

#include <algorithm>
#include <cmath>
#include <limits>

#include <weft/fast_solver/solver_report.hpp>

namespace weft::bridge {

/// How far the last step of a body with implicit springs was solved. It is the error of the equations of the step, beside that
/// of taking steps at all.
struct StepError {
  /// The distance of the nodes from the solution, root mean square over the mass [m]. It is a bound from the estimated gain of
  /// more iterations (fast::SolverReport). Sheets that crumple are more than twice as far off in one step of ten.
  double distance = 0.0;
  int newton_iterations =
      0;  ///< linearisations of the last solution; 0 for a body that sleeps, or has blown up
  /// To FastSettings::solver.tolerance, or as far as rounding allows. If not, its budget ended first, mostly.
  bool is_within_tolerance = true;

  /// Makes it the larger of itself and that of a solution. inertia_step: h' of SolverReport [s]; mass: of the body [kg].
  void include(const fast::SolverReport& report, double inertia_step, double mass) {
    const double found = inertia_step * std::sqrt(2 * report.energy_left / mass);
    distance = found >= 0 ? std::max(distance, found) : std::numeric_limits<double>::infinity();
    newton_iterations = std::max(newton_iterations, report.newton_iterations);
    is_within_tolerance = is_within_tolerance && report.is_converged && std::isfinite(distance);
  }
};

}  // namespace weft::bridge
