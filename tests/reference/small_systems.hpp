#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/reference/solver.hpp>

/// Systems small enough to be solved by hand, for the tests of the reference solver.
namespace weft::reference::testing {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

using Parameters = std::map<std::string, std::vector<double>, std::less<>>;

inline void add_law(Body& body, const std::string& law, Parameters parameters) {
  const forces::LawSpecification specification{law, {}, std::move(parameters)};
  body.laws.add(forces::make_law<double>(forces::checked(specification), body.mesh));
}

/// Nodes at rest on the x axis, spacing apart, with springs between neighbors.
inline Body make_chain(int num_nodes, double spacing, double mass, double stiffness) {
  Body body;
  body.name = "chain";
  body.mesh.rest_positions.setZero(3, num_nodes);
  body.mesh.masses.setConstant(num_nodes, mass);
  Edges edges(2, num_nodes - 1);
  for (int i = 0; i < num_nodes; ++i) body.mesh.rest_positions(0, i) = i * spacing;
  for (int i = 0; i + 1 < num_nodes; ++i) edges.col(i) << i, i + 1;
  body.mesh.edge_sets.push_back({"stretch", edges});
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, num_nodes);
  add_law(body, "tension", {{"stiffness", {stiffness}}});
  return body;
}

/// A single node without springs, under gravity [m/s^2].
inline Body make_free_node(double mass, const Vector3<double>& position,
                           const Vector3<double>& gravity) {
  Body body;
  body.name = "node";
  body.mesh.rest_positions = position;
  body.mesh.masses.setConstant(1, mass);
  body.positions = position;
  body.velocities.setZero(3, 1);
  add_law(body, "gravity", {{"acceleration", {gravity.x(), gravity.y(), gravity.z()}}});
  return body;
}

/// A horizontal square cloth of n x n nodes with tension and spring damping, at rest.
inline Body make_cloth(int n, double size, double mass, double height, double stiffness,
                       double damping) {
  Body body;
  body.name = "cloth";
  ClothGrid grid;
  grid.nodes = {n, n};
  grid.size = {size, size};
  grid.center = {0, height, 0};
  grid.total_mass = mass;
  grid.stencil = GridStencil::k12Neighbour;
  body.mesh = make_cloth_grid(grid);
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  add_law(body, "tension", {{"stiffness", {stiffness}}});
  if (damping > 0.0) add_law(body, "spring_damping", {{"damping", {damping}}});
  return body;
}

inline System system_of(Body body) {
  System system;
  system.bodies.push_back(std::move(body));
  return system;
}

/// A solver whose steps are all taken as one, whatever its error: what a discrete formula is about.
inline constexpr IntegratorSettings kNoErrorControl{.relative_tolerance = 1e200,
                                                    .absolute_tolerance = 1e200};

inline SpringSolver solver_of(Body body, IntegratorKind integrator) {
  return SpringSolver(system_of(std::move(body)),
                      {.integrator = integrator, .settings = kNoErrorControl});
}

inline constexpr IntegratorKind kAllIntegrators[] = {
    IntegratorKind::kExplicitEuler,    IntegratorKind::kModifiedEuler,
    IntegratorKind::kVelocityVerlet,   IntegratorKind::kRungeKutta4,
    IntegratorKind::kYoshida4,         IntegratorKind::kDormandPrince5,
    IntegratorKind::kImplicitEuler,    IntegratorKind::kTrBdf2,
    IntegratorKind::kImplicitMidpoint, IntegratorKind::kGeneralizedAlpha};

inline std::string name_of(IntegratorKind integrator) {
  switch (integrator) {
    case IntegratorKind::kExplicitEuler:
      return "explicit Euler";
    case IntegratorKind::kModifiedEuler:
      return "modified Euler";
    case IntegratorKind::kVelocityVerlet:
      return "velocity Verlet";
    case IntegratorKind::kRungeKutta4:
      return "Runge-Kutta 4";
    case IntegratorKind::kYoshida4:
      return "Yoshida 4";
    case IntegratorKind::kDormandPrince5:
      return "Dormand-Prince 5(4)";
    case IntegratorKind::kImplicitEuler:
      return "implicit Euler";
    case IntegratorKind::kTrBdf2:
      return "TR-BDF2";
    case IntegratorKind::kImplicitMidpoint:
      return "implicit midpoint";
    case IntegratorKind::kGeneralizedAlpha:
      return "generalised alpha";
  }
  return "?";
}

}  // namespace weft::reference::testing
