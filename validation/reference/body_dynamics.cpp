#include <weft/validation/reference/body_dynamics.hpp>

namespace weft::reference {

BodyDynamics::BodyDynamics(Body& body)
    : body_(&body), inverse_masses_(reference::inverse_masses(body.mesh)) {}

void BodyDynamics::evaluate(ConstMatrix3XRef<double> positions, ConstMatrix3XRef<double> velocities,
                            double time_in_step, VelocityLaws velocity_laws,
                            Matrix3XRef<double> accelerations) {
  accelerations.setZero();
  const forces::State<double> state{positions, velocities, body_->mesh.masses,
                                    time_ + time_in_step};
  forces::LawSet<double>& laws = body_->laws;
  const bool has_inertia = laws.has_level(forces::LawTraits::Level::kInertia);
  const forces::ForceReport report =
      laws.add_forces(state, has_inertia ? VelocityLaws::kSeparate : velocity_laws, accelerations);
  if (!report.ok() && !first_non_finite_node_) {
    first_non_finite_node_ = report.first_non_finite_node;
  }
  if (has_inertia && report.ok()) {
    laws.redistribute_forces(state, accelerations);
    if (velocity_laws == VelocityLaws::kAsForces) {
      (void)laws.add_forces(state, VelocityLaws::kAlone, accelerations);
    }
  }
  if (body_->external_forces.cols() > 0) accelerations += body_->external_forces;
  // A pinned node's inverse mass is 0, but 0 * inf would be NaN: division keeps the same bits as f
  // / m.
  for (Eigen::Index i = 0; i < accelerations.cols(); ++i) {
    if (inverse_masses_[i] == 0.0) {
      accelerations.col(i).setZero();
    } else {
      accelerations.col(i) /= body_->mesh.masses[i];
    }
  }
}

void BodyDynamics::advance_velocities(ConstMatrix3XRef<double> positions, double time_step,
                                      Matrix3X<double>& velocities) {
  before_ = velocities;
  const forces::State<double> state{positions, before_, body_->mesh.masses, time_};
  body_->laws.advance_velocities(state, time_step, velocities);
  set_pinned_velocities(body_->mesh, velocities);
}

}  // namespace weft::reference
