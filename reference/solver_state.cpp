// What a snapshot has of a solver.
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

template <class Value>
void serialize(StateArchive& archive, std::optional<Value>& optional) {
  bool is_set = optional.has_value();
  archive.value(is_set);
  if (archive.is_reading()) optional = is_set ? std::optional<Value>(Value{}) : std::nullopt;
  if (is_set) serialize(archive, *optional);
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
  reference::serialize(archive, stability_);
  reference::serialize(archive, blow_up_);
  for (auto& integrator : integrators_) {
    integrator = make_integrator(options_.integrator, options_.settings);
  }
}

}  // namespace weft::reference
