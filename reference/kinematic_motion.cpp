// The motion of nodes and colliders that is prescribed from outside. Everything else of the solver is in solver.cpp.
// Tested by tests/reference/self_contact_test.cpp, tests/engines/attach_test.cpp.
#include <string>

#include <Eigen/Cholesky>

#include <weft/core/error.hpp>
#include <weft/reference/solver.hpp>

namespace weft::reference {
namespace {

void check_size(const char* what, Eigen::Index given, Eigen::Index expected) {
  if (given == expected) return;
  throw InvalidArgument("reference solver: " + std::to_string(given) + " " + what + ", expected " +
                        std::to_string(expected));
}

void check_kinematic(const Collider& collider) {
  if (!collider.mass) return;
  throw InvalidArgument("reference solver: collider '" + collider.name +
                        "' has a mass and moves freely, expected one without");
}

}  // namespace

void SpringSolver::lead_pins(std::size_t body, ConstMatrix3XRef<double> targets, double time_step) {
  Body& moved = system_->bodies.at(body);
  const std::vector<int>& pinned = moved.mesh.pinned;
  check_size("targets of pinned nodes", targets.cols(), static_cast<Eigen::Index>(pinned.size()));
  moved.mesh.pinned_velocities = (targets - moved.positions(Eigen::all, pinned)) / time_step;
  set_pinned_velocities(moved.mesh, moved.velocities);
}

void SpringSolver::place_pins(std::size_t body, ConstMatrix3XRef<double> targets) {
  Body& moved = system_->bodies.at(body);
  check_size("targets of pinned nodes", targets.cols(),
             static_cast<Eigen::Index>(moved.mesh.pinned.size()));
  for (std::size_t i = 0; i < moved.mesh.pinned.size(); ++i) {
    moved.positions.col(moved.mesh.pinned[i]) = targets.col(static_cast<Eigen::Index>(i));
  }
}

void SpringSolver::limit_positions(std::size_t body, const PositionLimits& limits,
                                   double time_step) {
  Body& moved = system_->bodies.at(body);
  check_position_limits(limits, moved.mesh.num_nodes());
  if (limits.is_empty()) return;
  const VectorX<double>& inverse = dynamics_[body].inverse_masses();
  for (int i = 0; i < moved.mesh.num_nodes(); ++i) {
    if (inverse[i] == 0.0) continue;
    const Vector3<double> position = moved.positions.col(i);
    const Vector3<double> allowed = limited_position(limits, i, position);
    moved.positions.col(i) = allowed;
    moved.velocities.col(i) += (allowed - position) / time_step;
  }
}

void SpringSolver::set_external_forces(std::size_t body, const Matrix3X<double>& forces) {
  Body& moved = system_->bodies.at(body);
  if (forces.cols() > 0) check_size("external forces", forces.cols(), moved.mesh.num_nodes());
  moved.external_forces = forces;
}

void SpringSolver::lead_collider(std::size_t collider, const Vector3<double>& position,
                                 const Eigen::Quaterniond& orientation, double time_step) {
  Collider& moved = system_->colliders.at(collider);
  check_kinematic(moved);
  moved.velocity = (position - moved.position) / time_step;
  Eigen::Quaterniond turn = orientation * moved.orientation.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();  // the shorter way round
  const Eigen::AngleAxisd angle_axis(turn);
  moved.angular_velocity = angle_axis.angle() / time_step * angle_axis.axis();
}

void SpringSolver::place_collider(std::size_t collider, const Vector3<double>& position,
                                  const Eigen::Quaterniond& orientation) {
  Collider& moved = system_->colliders.at(collider);
  check_kinematic(moved);
  moved.position = position;
  moved.orientation = orientation;
}

void SpringSolver::push_collider(std::size_t collider, const Vector3<double>& force,
                                 const Vector3<double>& torque, double time_step) {
  Collider& pushed = system_->colliders.at(collider);
  if (!pushed.mass) return;
  pushed.velocity += time_step / *pushed.mass * force;
  const Matrix3<double> inertia = world_inertia(pushed);
  pushed.angular_velocity += inertia.ldlt().solve(time_step * torque);
}

}  // namespace weft::reference
