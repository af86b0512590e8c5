#include <weft/validation/cases/small_systems.hpp>

#include <utility>

#include <weft/custom_forces/registry.hpp>
#include <weft/validation/cases/sabotage.hpp>

namespace weft::validation {

reference::Body make_row(const SpringRow& row) {
  reference::Body body;
  body.name = "row";
  const int num_nodes = row.num_springs + 1;
  body.mesh.rest_positions.resize(3, num_nodes);
  Edges edges(2, row.num_springs);
  for (int i = 0; i < num_nodes; ++i) {
    body.mesh.rest_positions.col(i) = (i * row.spacing) * row.direction;
    if (i > 0) edges.col(i - 1) << i - 1, i;
  }
  body.mesh.edge_sets.push_back({"row", edges});
  body.mesh.masses = VectorX<double>::Constant(num_nodes, row.mass);
  body.mesh.pinned = {0};
  for (const forces::LawSpecification& specification : row.laws) {
    auto law = forces::make_law<double>(specification, body.mesh);
    const bool flip = row.flip_damping && law->info().traits.dissipative;
    body.laws.add(flip ? negated(std::move(law)) : std::move(law));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, num_nodes);
  return body;
}

forces::LawSpecification tension_law(double stiffness) {
  return {"tension", {}, {{"stiffness", {stiffness}}}};
}

forces::LawSpecification spring_damping_law(double damping) {
  return {"spring_damping", {}, {{"damping", {damping}}}};
}

forces::LawSpecification velocity_damping_law(double rate) {
  return {"velocity_damping", {}, {{"rate", {rate}}}};
}

forces::LawSpecification gravity_law(const Vector3<double>& acceleration) {
  return {"gravity", {}, {{"acceleration", {acceleration[0], acceleration[1], acceleration[2]}}}};
}

reference::SpringSolver make_solver(reference::Body body, reference::IntegratorKind integrator) {
  reference::System system;
  system.bodies.push_back(std::move(body));
  reference::SolverOptions options;
  options.integrator = integrator;
  return reference::SpringSolver(std::move(system), options);
}

const char* name_of(reference::IntegratorKind integrator) {
  switch (integrator) {
    case reference::IntegratorKind::kExplicitEuler:
      return "explicit Euler";
    case reference::IntegratorKind::kModifiedEuler:
      return "modified Euler";
    case reference::IntegratorKind::kVelocityVerlet:
      return "velocity Verlet";
    case reference::IntegratorKind::kRungeKutta4:
      break;
  }
  return "Runge-Kutta 4";
}

}  // namespace weft::validation
