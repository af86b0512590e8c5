#include <weft/validation/cases/support/small_systems.hpp>

#include <utility>

#include <weft/custom_forces/registry.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {

namespace {

void add_laws(reference::Body& body, const std::vector<forces::LawSpecification>& laws,
              bool flip_damping) {
  for (const forces::LawSpecification& specification : laws) {
    auto law = forces::make_law<double>(specification, body.mesh);
    const bool flip = flip_damping && law->info().traits.dissipative;
    body.laws.add(flip ? negated(std::move(law)) : std::move(law));
  }
}

}  // namespace

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
  add_laws(body, row.laws, row.flip_damping);
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, num_nodes);
  return body;
}

reference::Body make_body(const SpringBody& springs) {
  reference::Body body;
  body.name = "body";
  body.mesh.rest_positions = springs.positions;
  body.mesh.triangles.resize(3, 0);
  body.mesh.edge_sets.push_back({"springs", springs.edges});
  body.mesh.masses = springs.masses;
  add_laws(body, springs.laws, springs.flip_damping);
  body.positions = springs.positions;
  body.velocities.setZero(3, springs.positions.cols());
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

forces::LawSpecification rotation_damping_law(double rate) {
  return {"rotation_damping", {}, {{"rate", {rate}}}};
}

forces::LawSpecification torsional_rotation_damping_law(double rate) {
  return {"torsional_rotation_damping", {}, {{"rate", {rate}}}};
}

forces::LawSpecification acceleration_damping_law(double beta) {
  return {"acceleration_damping", {}, {{"beta", {beta}}}};
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
    case reference::IntegratorKind::kYoshida4:
      return "Yoshida 4";
    case reference::IntegratorKind::kDormandPrince5:
      return "Dormand-Prince 5(4)";
    case reference::IntegratorKind::kImplicitEuler:
      return "implicit Euler";
    case reference::IntegratorKind::kTrBdf2:
      return "TR-BDF2";
    case reference::IntegratorKind::kImplicitMidpoint:
      return "implicit midpoint";
    case reference::IntegratorKind::kGeneralizedAlpha:
      return "generalised alpha";
    case reference::IntegratorKind::kRungeKutta4:
      break;
  }
  return "Runge-Kutta 4";
}

}  // namespace weft::validation
