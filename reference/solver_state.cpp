// A snapshot saves a solver by one function in both directions.
// Tested by tests/engines/snapshot_test.cpp.
#include <weft/reference/solver.hpp>

namespace weft::reference {
namespace {

void serialize(StateArchive& archive, Body& body) {
  const Eigen::Index num_nodes = body.positions.cols();
  archive.value(body.positions);
  archive.value(body.velocities);
  archive.value(body.external_forces);
  archive.value(body.mesh.pinned_velocities);
  if (body.positions.cols() != num_nodes || body.velocities.cols() != num_nodes) {
    archive.refuse("body '" + body.name + "' has " + std::to_string(body.positions.cols()) +
                   " nodes, expected " + std::to_string(num_nodes));
  }
}

void serialize(StateArchive& archive, Collider& collider) {
  archive.value(collider.position);
  archive.value(collider.orientation.coeffs());
  archive.value(collider.velocity);
  archive.value(collider.angular_velocity);
}

void serialize(StateArchive& archive, Stability& stability) {
  archive.value(stability.stable_step);
  archive.value(stability.body);
  archive.value(stability.spectrum.omega_max);
  archive.value(stability.spectrum.gamma_force_max);
  archive.value(stability.spectrum.gamma_velocity_max);
  archive.value(stability.spectrum.top_mode_damping);
}

void serialize(StateArchive& archive, BlowUp& blow_up) {
  archive.value(blow_up.body);
  archive.value(blow_up.node);
  archive.value(blow_up.reason);
}

}  // namespace

void SpringSolver::serialize(StateArchive& archive) {
  archive.part("reference solver");
  archive.expect(system_->bodies.size(), "number of bodies");
  archive.expect(system_->colliders.size(), "number of colliders");
  for (Body& body : system_->bodies) reference::serialize(archive, body);
  for (Collider& collider : system_->colliders) reference::serialize(archive, collider);
  archive.value(time_);
  archive.value(steps_since_estimate_);
  const auto each = [&](auto& value) { reference::serialize(archive, value); };
  archive.optional(stability_, each);
  archive.optional(blow_up_, each);
  for (auto& integrator : integrators_) {
    integrator = make_integrator(options_.integrator, options_.settings);
  }
}

}  // namespace weft::reference
