// The methods that integrate a step: implicit Euler, BDF2 and that of ForceHistory, and the energy that is left to a step.
// Tested by tests/bridge/implicit/fast_body_test.cpp, tests/bridge/implicit/stiffness_limit_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/implicit/energy_limit.hpp>
#include <weft/bridge/implicit/fast_body.hpp>
#include <weft/bridge/implicit/node_anchors.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// How much a step may gain by rounding, as a share of m |y - q|^2 / (2 h^2) [-].
constexpr double kEnergySlack = 0.01;

/// How much a method may seem to gain whose velocities are those of the middle of a step, as a share of all energy [-].
constexpr double kBalanceSlack = 3e-2;

bool leads_movable(const btSoftBody& body) {
  bool leads = false;
  for_anchors(body,
              [&](const NodeAnchor& anchor) { leads = leads || MovableObject(anchor.object); });
  return leads;
}

/// Whether what cloth touches may do work that nobody knows.
template <class MovesFreely>
bool may_do_work(const std::vector<RigidContact>& contacts, const MovesFreely& moves_freely) {
  const btCollisionObject* known = nullptr;  // that does none but by its motion
  for (const RigidContact& contact : contacts) {
    if (contact.motion.length2() > 0 && !contact.is_dynamic) return true;
    if (contact.object == known) continue;
    known = contact.object;
    const MovableObject object{contact.object};
    // Nobody knows how a ghost moves, and what the motors of joints do.
    if (object ? !moves_freely(object) : btRigidBody::upcast(contact.object) == nullptr)
      return true;
  }
  return false;
}

}  // namespace

// BDF2 extrapolates a change of velocity between steps and makes 4/3 of it: such a step is implicit
// Euler, which counts it once. The steps after it have a history that has had that velocity. Velocities of pins belong to
// whoever leads them, and are range of no history.
bool FastBody::was_changed_outside() {
  if (impulses_.cols() > 0) return true;
  if (left_velocities_.cols() != start_velocities_.cols()) return false;
  for (const int pin : pins_) left_velocities_.col(pin) = start_velocities_.col(pin);
  return left_velocities_ != start_velocities_;
}

bool FastBody::may_use_history(const btSoftBody& body, btScalar time_step) {
  if (!settings_.is_second_order || last_step_ != time_step || !contacts_.empty() ||
      body.m_scontacts.size() > 0 || was_changed_outside()) {
    return false;
  }
  // A body on an anchor gets the impulse of a whole step, and BDF2 solves with another inertia step.
  return !leads_movable(body) && are_positions_kept();
}

// With dynamic bodies that springs throw back. What only lies there comes to rest by the damping of implicit Euler.
bool FastBody::may_use_forces(const btSoftBody& body, btScalar time_step) {
  if (!settings_.is_second_order || !force_history_.fits(starts_.cols(), time_step) ||
      body.m_scontacts.size() > 0) {
    return false;
  }
  const auto is_lively = [&](const btCollisionObject* other) {
    const MovableObject object{other};
    if (!moves_freely(object)) return false;
    const btScalar least = SubstepCount::kLively * object.gravity().length() * time_step;
    const btScalar change = pushed_.displacement_of(object).template head<3>().norm() / time_step;
    return object.velocity().linear.length() > least || change > least;
  };
  bool is_any = std::any_of(contacts_.begin(), contacts_.end(),
                            [&](const RigidContact& contact) { return is_lively(contact.object); });
  for_anchors(body, [&](const NodeAnchor& anchor) { is_any = is_any || is_lively(anchor.object); });
  return is_any && are_positions_kept();
}

// Somebody may have moved a node since the last step.
bool FastBody::are_positions_kept() {
  if (positions_.cols() != starts_.cols()) return false;
  for (const int pin : pins_) positions_.col(pin) = starts_.col(pin);
  std::array<bool, fast::WorkerTeam::kMostParts> is_same;
  is_same.fill(true);
  fast::run_parts(team_, static_cast<int>(starts_.cols()), [&](int range, int begin, int end) {
    is_same[static_cast<std::size_t>(range)] =
        positions_.middleCols(begin, end - begin) == starts_.middleCols(begin, end - begin);
  });
  return std::all_of(is_same.begin(), is_same.end(), [](bool same) { return same; });
}

FastBody::Method FastBody::choose_method(const btSoftBody& body, btScalar time_step) {
  if (is_explicit_) return Method::kExplicit;
  if (may_use_history(body, time_step)) return Method::kBdf2;
  return may_use_forces(body, time_step) ? Method::kForces : Method::kImplicitEuler;
}

// From what Bullet has predicted, velocities v + h a: where nodes would go without springs.
void FastBody::set_targets(const btSoftBody& body, Method method, btScalar time_step) {
  const bool uses_history = method == Method::kBdf2;
  method_ = method;
  inertia_step_ = uses_history                ? time_step * 2 / 3
                  : method == Method::kForces ? std::sqrt(ForceHistory::kShare) * time_step
                                              : time_step;
  velocity_step_ = uses_history ? inertia_step_ : time_step;
  if (method == Method::kForces) force_history_.begin_step(time_step);
  if (method == Method::kExplicit) explicit_.find_forces(*solver_, bending_, starts_, team_);
  for (Matrix3X<btScalar>* vectors : {&origins_, &targets_, &positions_}) {
    vectors->resize(3, starts_.cols());
  }
  for_nodes([&](int begin, int count) {
    const auto of = [&](Matrix3X<btScalar>& vectors) { return vectors.middleCols(begin, count); };
    if (uses_history) {
      of(origins_) = (4 * of(starts_) - of(last_starts_)) / 3;
      of(targets_) = of(origins_) +
                     inertia_step_ * ((4 * of(start_velocities_) - of(last_velocities_)) / 3 +
                                      (of(predicted_) - of(start_velocities_)) * btScalar(2) / 3);
    } else {
      of(origins_) = of(starts_);
      of(targets_) = of(origins_) + time_step * of(predicted_);
    }
    if (method == Method::kExplicit)
      explicit_.set_targets(begin, count, time_step, masses_, starts_, predicted_, targets_);
    if (method == Method::kForces) {
      for (int i = begin; i < begin + count; ++i) {
        const auto mass = static_cast<btScalar>(masses_[i]);
        if (mass > 0) targets_.col(i) += time_step * time_step / mass * force_history_.known(i);
      }
    }
    of(positions_) = of(starts_) + time_step * of(start_velocities_);
    // Springs may hold back at once what a force would do alone.
    if (impulses_.cols() > 0) of(positions_) -= time_step * of(impulses_);
  });
  for (const int pin : pins_) {
    targets_.col(pin) = from_bullet<btScalar>(body.m_nodes[pin].m_x) - origin_;
  }
}

void FastBody::find_velocities() {
  velocities_.resize(3, positions_.cols());
  for_nodes([&](int begin, int count) {
    auto velocities = velocities_.middleCols(begin, count);
    velocities = positions_.middleCols(begin, count) - origins_.middleCols(begin, count);
    active_solver().add_compensation(begin, velocities);
    if (method_ == Method::kExplicit) velocities += explicit_.target_rounding(begin, count);
    velocities /= velocity_step_;
  });
}

// Pins and anchors that lead, kinematic colliders and other cloth do work that nobody knows.
bool FastBody::gets_work_from_outside() const {
  if (!kinematic_.empty() ||
      may_do_work(contacts_, [&](const MovableObject& one) { return moves_freely(one); }))
    return true;
  return std::any_of(pins_.begin(), pins_.end(),
                     [&](int pin) { return positions_.col(pin) != starts_.col(pin); });
}

// Only where a dynamic body is near enough that springs may have to throw it back.
void FastBody::keep_forces(const btSoftBody& body, btScalar time_step) {
  const bool is_any_near =
      leads_movable(body) ||
      std::any_of(colliders_.begin(), colliders_.end(),
                  [](const Collider& collider) { return bool(MovableObject(collider.object)); });
  if (!is_any_near || method_ == Method::kExplicit) return force_history_.forget();
  force_history_.resize(positions_.cols(), time_step);
  for_nodes([&](int begin, int count) {
    solver_->get_forces(begin, force_history_.coming(begin, count));
    force_history_.add(begin, count);
  });
}

FastBody::EnergyBalance FastBody::energy_balance(btScalar time_step, double for_bodies) {
  weights_.resize(3, masses_.size());
  for (int axis = 0; axis < 3; ++axis) weights_.row(axis) = masses_.transpose().cast<btScalar>();
  for (const int pin : pins_) weights_.col(pin).setZero();
  const double given = energy_put_in(
      {weights_, starts_, start_velocities_, predicted_, positions_, time_step}, team_);
  const auto stored_at = [this](const Matrix3X<btScalar>& positions) {
    return solver_->spring_energy(positions, team_) + bending_.energy(positions);
  };
  const double start = stored_at(starts_);
  const double end = stored_at(positions_);
  const bool is_between = method_ == Method::kForces || method_ == Method::kExplicit;
  // Where velocities are those of the middle of a step, what springs store from middle to middle counts.
  double stored = end - start;
  if (is_between) {
    const btScalar share = std::min(btScalar(1), time_step / last_spacing_);
    stored += static_cast<double>(share) * (start - stored_at(last_starts_));
    stored /= 2;
  }
  const double slack =
      !is_between ? kEnergySlack * active_solver().step_energy() : kBalanceSlack * (given + start);
  return {kinetic_energy(weights_, velocities_, team_),
          given - for_bodies - stored - excess_ + slack};
}

// A node that is put out of a surface after the solution stretches springs, and a very stiff sheet would throw it back with
// energy that nobody has given to it. What is stored in springs cannot be taken away without another step: it is kept in mind
// until it comes out as motion. Solutions without contacts that stay as they are gain nothing and are not looked at; a plane may
// have a node's start behind it, where the surface is curved and the node fast.
void FastBody::limit_kinetic_energy(btScalar time_step) {
  if (method_ == Method::kExplicit || gets_work_from_outside()) {
    excess_ = 0;
    return;
  }
  const bool is_free = contacts_.empty() && pushed_.empty() && !is_projected_;
  if (active_solver().report().is_converged && is_free && excess_ == 0) return;
  const EnergyBalance balance = energy_balance(time_step, given_to_bodies_);
  if (balance.kinetic > balance.most) {
    limit_energy(weights_, balance.most, pins_.empty(), velocities_, team_);
  }
  const bool is_debt = is_projected_ || !pushed_.empty() || excess_ > 0;
  excess_ = is_debt ? std::max(0.0, -balance.most) : 0.0;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
