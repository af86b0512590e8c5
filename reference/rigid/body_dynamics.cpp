#include <weft/reference/rigid/body_dynamics.hpp>

#include <weft/reference/statics/coupling.hpp>

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

void BodyDynamics::multiply_jacobian(Reach reach, ConstMatrix3XRef<double> positions,
                                     ConstMatrix3XRef<double> velocities, double time_in_step,
                                     ConstMatrix3XRef<double> displacements,
                                     ConstMatrix3XRef<double> velocity_changes,
                                     Matrix3XRef<double> product) {
  using Level = forces::LawTraits::Level;
  const forces::State<double> state{positions, velocities, body_->mesh.masses,
                                    time_ + time_in_step};
  const auto add = [&](bool velocity_level) {
    for (const auto& law : body_->laws.laws()) {
      const forces::LawTraits& traits = law->info().traits;
      if ((traits.level == Level::kVelocity) != velocity_level) continue;
      if (reach == Reach::kShort && !has_short_reach(traits)) continue;
      if (scratch_.cols() < law->scratch_columns()) scratch_.setZero(3, law->scratch_columns());
      law->add_stiffness_product(state, displacements, scratch_, product);
      law->add_damping_product(state, velocity_changes, scratch_, product);
    }
  };
  product.setZero();
  add(false);
  if (reach == Reach::kAll) body_->laws.redistribute_forces(state, product);
  add(true);
}

void BodyDynamics::advance_velocities(ConstMatrix3XRef<double> positions, double time_step,
                                      Matrix3X<double>& velocities) {
  before_ = velocities;
  const forces::State<double> state{positions, before_, body_->mesh.masses, time_};
  body_->laws.advance_velocities(state, time_step, velocities);
  set_pinned_velocities(body_->mesh, velocities);
}

}  // namespace weft::reference
