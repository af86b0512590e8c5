#pragma once

#include <algorithm>
#include <cmath>

#include <weft/validation/metrics/distance/self_intersection.hpp>

#include "tests/reference/small_systems.hpp"

/// Runs in which layers of one cloth meet, and how often an edge was inside a triangle.
namespace weft::reference::testing {

inline int piercings(const Body& body) {
  return static_cast<int>(validation::self_piercings(body.positions, body.mesh.triangles).size());
}

/// A strip that falls on its lower edge and folds up on the ground.
inline System folding_strip(int n, bool self_contact) {
  Body body;
  body.name = "strip";
  ClothGrid grid;
  grid.nodes = {n, 3 * n};
  grid.size = {0.2, 0.6};
  grid.center = {0, 0.42, 0};
  grid.u_axis = {1, 0, 0};
  grid.v_axis = {0, 1, 0.05};
  grid.total_mass = 0.03;
  grid.stencil = GridStencil::k12Neighbour;
  body.mesh = make_cloth_grid(grid);
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  add_law(body, "tension", {{"stiffness", {20.0}}});
  add_law(body, "spring_damping", {{"damping", {2e-3}}});
  add_law(body, "gravity", {{"acceleration", {0, -9.81, 0}}});
  add_law(body, "velocity_damping", {{"rate", {1.0}}});
  body.collision_margin = 4e-3;
  body.friction = 0.4;
  body.self_contact = self_contact;
  body.self_thickness = 6e-3;
  System system = system_of(std::move(body));
  system.colliders.push_back({.name = "ground", .shape = Plane{}});
  return system;
}

inline int crossings_of_fold(System system, double duration, int* stopped) {
  SpringSolver solver(std::move(system));
  const double h = 0.5 * solver.stability().stable_step;
  int count = 0;
  while (solver.time() < duration) {
    const StepOutcome outcome = solver.step(h);
    if (stopped != nullptr) *stopped += outcome.contact.num_stopped_nodes;
    if (outcome.blow_up) return -1;
    count += piercings(solver.system().bodies[0]);
  }
  return count;
}

/// A cloth between two rows of pinned nodes that turn against each other about the x axis.
inline int crossings_of_twist(int n, double turns, bool self_contact, int* stopped) {
  Body body = make_cloth(n, 0.5, 0.05, 0.0, 40.0, 5e-3);
  add_law(body, "velocity_damping", {{"rate", {2.0}}});
  for (int side : {0, n - 1}) {
    for (int j = 0; j < n; ++j) body.mesh.pinned.push_back(j * n + side);
  }
  std::sort(body.mesh.pinned.begin(), body.mesh.pinned.end());
  body.self_contact = self_contact;
  body.self_thickness = 6e-3;
  body.friction = 0.3;
  const Matrix3X<double> rest = body.mesh.rest_positions;
  const std::vector<int> pinned = body.mesh.pinned;
  // Out of the plane: of exactly coplanar edges and triangles the count would see rounding.
  for (int i = 0; i < body.mesh.num_nodes(); ++i) {
    body.positions(1, i) += 1e-4 * std::sin(40 * rest(0, i)) * std::cos(30 * rest(2, i) + 1);
  }
  SpringSolver solver(system_of(std::move(body)));
  const double h = 0.5 * solver.stability().stable_step;
  const double rate = 2 * M_PI;  // [rad/s] of each side
  int count = 0;
  while (solver.time() * rate < M_PI * turns) {
    const double angle = rate * (solver.time() + h);
    Matrix3X<double> targets(3, static_cast<Eigen::Index>(pinned.size()));
    for (std::size_t i = 0; i < pinned.size(); ++i) {
      const Vector3<double> from = rest.col(pinned[i]);
      const double sign = from.x() < 0 ? -1.0 : 1.0;
      Vector3<double> to = Eigen::AngleAxisd(sign * angle, Vector3<double>::UnitX()) * from;
      to.x() *= 0.8;  // slack, so that it can wind up
      if (solver.time() < 0.1) to.x() = from.x() * (1 - 0.2 * (solver.time() + h) / (0.1 + h));
      targets.col(static_cast<Eigen::Index>(i)) = to;
    }
    solver.lead_pins(0, targets, h);
    const StepOutcome outcome = solver.step(h);
    solver.place_pins(0, targets);
    if (stopped != nullptr) *stopped += outcome.contact.num_stopped_nodes;
    if (outcome.blow_up) return -1;
    count += piercings(solver.system().bodies[0]);
  }
  return count;
}

}  // namespace weft::reference::testing
