#include <weft/reference/balance.hpp>

#include <weft/reference/rigid/rigid_motion.hpp>

namespace weft::reference {
namespace {

/// What velocity-level laws take out of the kinetic energy that inertia-level laws store [W].
double power_on_added_inertia(const Body& body) {
  using Level = forces::LawTraits::Level;
  if (!body.laws.has_level(Level::kInertia) || !body.laws.has_level(Level::kVelocity)) return 0.0;
  Matrix3X<double> change = Matrix3X<double>::Zero(3, body.positions.cols());
  const forces::State<double> state{body.positions, body.velocities, body.mesh.masses};
  for (const auto& law : body.laws.laws()) {
    if (law->info().traits.level != Level::kVelocity) continue;
    Matrix3X<double> scratch(3, law->scratch_columns());
    law->add_forces(state, scratch, change);
  }
  change *= inverse_masses(body.mesh).asDiagonal();
  const auto stored = [&](const Matrix3X<double>& velocities) {
    return body.laws.added_kinetic_energy({body.positions, velocities, body.mesh.masses});
  };
  // The energy is a quadratic form, for which this difference is the derivative along change.
  return 0.5 * (stored(body.velocities + change) - stored(body.velocities - change));
}

}  // namespace

Energies energies(const System& system, double time) {
  Energies sum;
  for (const Body& body : system.bodies) {
    const forces::State<double> state{body.positions, body.velocities, body.mesh.masses, time};
    sum.kinetic += 0.5 * body.velocities.colwise().squaredNorm().dot(body.mesh.masses);
    sum.kinetic += body.laws.added_kinetic_energy(state);
    sum.potential += body.laws.potential_energy(state);
    sum.power += body.laws.non_conservative_power(state) + power_on_added_inertia(body);
  }
  for (const Collider& collider : system.colliders) {
    if (!collider.mass) continue;
    sum.kinetic += 0.5 * (*collider.mass * collider.velocity.squaredNorm() +
                          collider.angular_velocity.dot(angular_momentum(collider)));
    sum.potential -= *collider.mass * system.gravity.dot(collider.position);
  }
  return sum;
}

Vector3<double> linear_momentum(const System& system) {
  Vector3<double> sum = Vector3<double>::Zero();
  for (const Body& body : system.bodies) sum += body.velocities * body.mesh.masses;
  for (const Collider& collider : system.colliders) {
    if (collider.mass) sum += *collider.mass * collider.velocity;
  }
  return sum;
}

Vector3<double> angular_momentum(const System& system) {
  Vector3<double> sum = Vector3<double>::Zero();
  for (const Body& body : system.bodies) {
    for (Eigen::Index i = 0; i < body.positions.cols(); ++i) {
      const Vector3<double> position = body.positions.col(i);
      sum += body.mesh.masses[i] * position.cross(body.velocities.col(i));
    }
  }
  for (const Collider& collider : system.colliders) {
    if (!collider.mass) continue;
    sum += *collider.mass * collider.position.cross(collider.velocity) + angular_momentum(collider);
  }
  return sum;
}

}  // namespace weft::reference
