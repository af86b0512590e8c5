#include <weft/validation/cases/support/stable_step_search.hpp>

#include <cmath>
#include <utility>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace {

constexpr double kStableStepSearchDisturbance = 1e-7;  // [m]
constexpr double kStableStepSearchGrown =
    1e-3;  // [m]: 1e4 times as large, and still 1 % of a spring's length
// A step 1e-3 beyond the stable one grows by exp(2 sqrt(2e-3)) per step, 1e15 in this many.
constexpr int kStableStepSearchNumSteps = 400;

bool is_stable(reference::Body body, double time_step) {
  // In the plane of the cloth, where every spring resists, and another for each node and axis.
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    body.positions(0, node) += kStableStepSearchDisturbance * std::sin(7.0 * node + 1.0);
    body.positions(2, node) += kStableStepSearchDisturbance * std::sin(11.0 * node + 2.0);
  }
  reference::SpringSolver solver =
      make_solver(std::move(body), reference::IntegratorKind::kModifiedEuler);
  const reference::Body& now = solver.system().bodies[0];
  for (int step = 0; step < kStableStepSearchNumSteps; ++step) {
    if (solver.step(time_step).blow_up) return false;
    if ((now.positions - now.mesh.rest_positions).cwiseAbs().maxCoeff() > kStableStepSearchGrown)
      return false;
  }
  return true;
}

}  // namespace

reference::Body floating_cloth(double beta) {
  ClothGrid grid;
  grid.nodes = {8, 8};
  grid.size = {1.0, 1.0};
  grid.total_mass = 0.3;
  grid.stencil = GridStencil::k12Neighbour;
  reference::Body body;
  body.name = "cloth";
  body.mesh = make_cloth_grid(grid);
  body.laws.add(forces::make_law<double>(tension_law(200.0), body.mesh));
  if (beta > 0) {
    body.laws.add(forces::make_law<double>(acceleration_damping_law(beta), body.mesh));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  return body;
}

double largest_stable_step(const std::function<reference::Body()>& make) {
  double stable = 1e-5;
  double unstable = 1.0;
  while (unstable > (1 + kStepResolution) * stable) {
    const double middle = std::sqrt(stable * unstable);
    (is_stable(make(), middle) ? stable : unstable) = middle;
  }
  return std::sqrt(stable * unstable);
}

}  // namespace weft::validation
