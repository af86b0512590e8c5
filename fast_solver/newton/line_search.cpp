// Line search and fallbacks, which keep a step from gaining energy or momentum even if it has not converged.
// Tested by tests/fast_solver/implicit_solver_test.cpp.
#include <algorithm>

#include <weft/fast_solver/implicit_solver.hpp>

#include <weft/core/index.hpp>

namespace weft::fast {
namespace {

/// A step that leaves more of the slope than this, either way, has another length [-].
constexpr double kMuchLeft = 0.5;
/// The smallest fraction of a step that is taken, and the largest multiple [-].
constexpr double kSmallestShare = 0.1;
constexpr double kLongest = 20;
/// The share of that energy that rounding may make of a step that changes nothing [-].
constexpr double kRoundingShare = 0.01;
/// Iterations of a step that the budget has left with more energy than it began with.
constexpr int kSafeIterations = 8;
/// Halvings of a whole step towards where it began, and of one iteration.
constexpr int kHalvings = 6;
constexpr int kHalvingsOfIteration = 8;
/// A motion with so many times the energy of the motion without springs has gone astray, and is begun anew [-].
constexpr double kFarUp = 10;

}  // namespace

// Shortens the step where the linear model fails, because springs turn far in one step. The test is the directional derivative of the
// energy at the end of the step. If it opposes the step by more than half of what drove it, the step is cut back to the zero
// of the secant.
//
// Compressed springs are softer than the linear model, so that such steps end with much of the slope that they began with, and each
// covers the same part of the way that is left. Close to the solution they are lengthened, to the zero of the secant too. Far from it
// nodes would jump into other folds.
template <class Scalar>
bool ImplicitSolver<Scalar>::line_search(const StepProblem<Scalar>& problem,
                                         const NewtonIteration& iteration, double work_before) {
  const auto find_slope = [&] {
    const double left = work_left_ + work_of_bodies() - work_of_constraints(problem, positions_);
    last_gain_.slope_left = work_before > 0 ? left / work_before : 0;
  };
  find_slope();
  const double slope = last_gain_.slope_left;
  was_lengthened_ = false;
  if (slope < -kMuchLeft) {
    const auto excess = static_cast<Scalar>(1 - std::max(kSmallestShare, 1 / (1 - slope)));
    for (const int i : constrained_) step_.row(i).setZero();
    add_carried(links_, bodies_, &Body::step, step_);
    move_bodies(-excess);
    positions_ -= excess * step_.template cast<Scalar>();
    return true;
  }
  was_lengthened_ = slope > kMuchLeft && last_gain_.total <= iteration.most_to_lengthen;
  if (!was_lengthened_) return false;
  // The part of the step that put nodes onto their planes is not repeated, because it would take them off again.
  for_each_part([this](NodeRange nodes) { project(nodes, step_); });
  const auto go = [&](double share) {
    positions_ += static_cast<Scalar>(share) * step_.template cast<Scalar>();
    evaluate(iteration.linearizes);
    find_slope();
  };
  const double further = 1 / std::max(1 - slope, 1 / kLongest) - 1;
  go(further);
  const double beyond = last_gain_.slope_left;
  if (beyond < -kMuchLeft) go(further * beyond / (slope - beyond));
  return false;
}

// Where bending is followed, halves the iteration until the energy, now, is at most this: hinges that are bent far turn over, and their
// moments with them. Returns the energy.
template <class Scalar>
double ImplicitSolver<Scalar>::shorten_bending(const StepProblem<Scalar>& problem, double now,
                                               double most) {
  int tries = 0;
  for (; step_forces_.has_elements() && !(now <= most) && tries < kHalvingsOfIteration; ++tries) {
    positions_ = Scalar(0.5) * (positions_ + last_positions_);
    for (Body& body : bodies_) body.motion = Scalar(0.5) * (body.motion + body.last_motion);
    now = energy(problem, positions_, &Body::motion);
  }
  if (tries > 0) evaluate();
  return now;
}

template <class Scalar>
double ImplicitSolver<Scalar>::energy_of(NodeRange nodes, const Nodes& positions) const {
  const double squares =
      sum_kernel<Scalar>().weighted_distance(weights_.data(), static_cast<int>(weights_.size()),
                                             nodes, positions.data(), inertial_positions_.data());
  return forces_.potential(nodes, positions) + 0.5 * squares;
}

// The incremental potential [J], including two-way coupled bodies and the dissipation of friction.
template <class Scalar>
double ImplicitSolver<Scalar>::energy(const StepProblem<Scalar>& problem, const Nodes& positions,
                                      Vector6 Body::*motion) {
  return sum_over_parts([&](NodeRange nodes) { return energy_of(nodes, positions); }) +
         step_forces_.energy(positions) + energy_of_contacts(problem, positions, motion);
}

template <class Scalar>
double ImplicitSolver<Scalar>::energy_of_contacts(const StepProblem<Scalar>& problem,
                                                  const Nodes& positions,
                                                  Vector6 Body::*motion) const {
  double sum = couplings_.energy(bodies_, motion) +
               supports_.energy(positions, start_positions_, bodies_, motion);
  for (const Body& body : bodies_) {
    const Vector6& displacement = body.*motion;
    sum += 0.5 * static_cast<double>(
                     displacement.dot(body.inertia.template cast<Scalar>() * displacement));
  }
  for (const int i : constrained_) {
    if (contact_of_[at(i)] < 0) continue;
    // A surface that is kinematic may do work by friction; slip only takes it away.
    const PlaneContact<Scalar>& contact = problem.contacts[at(contact_of_[at(i)])];
    if (contact_states_[at(i)] != ContactState::kOnPlane) continue;
    const Vector3<Scalar> slip = slip_of(contact, at_node(positions, i), motion);
    if (is_on_link(contact)) {
      sum -= static_cast<double>(
          std::min(Scalar(0), slip.dot(friction_.force(i).template cast<Scalar>())));
    } else {
      sum += static_cast<double>(friction_.energy(i, slip.norm()));
    }
  }
  return sum;
}

// The start of the step with kinematic nodes moved, projected in front of all planes.
template <class Scalar>
void ImplicitSolver<Scalar>::stay_at_start(const StepProblem<Scalar>& problem) {
  for_each_part([&](NodeRange nodes) {
    const int count = nodes.end - nodes.begin;
    unmoved_.middleRows(nodes.begin, count) = start_positions_.middleRows(nodes.begin, count);
  });
  for (const int node : pinned_) unmoved_.row(node) = inertial_positions_.row(node);
  for (Body& body : bodies_) {
    body.unmoved = body.is_linked ? Vector6(-body.motion_alone) : Vector6(Vector6::Zero());
  }
  for (const KinematicNode<Scalar>& kinematic : problem.kinematic) {
    Vector3<Scalar> position = kinematic.position;
    if (kinematic.body >= 0)
      position += motion_at(bodies_[at(kinematic.body)].unmoved, kinematic.lever_arm);
    unmoved_.row(kinematic.node) = position.transpose();
  }
  for (const PlaneContact<Scalar>& contact : problem.contacts) {
    // Nodes between the fingers of a robot are held by both: out of one they would be in the other.
    if (!is_free_[at(contact.node)] || is_on_link(contact)) continue;
    if (contact.body < 0 && contact_states_[at(contact.node)] == ContactState::kFixed) {
      unmoved_.row(contact.node) = start_positions_.row(contact.node) + contact.motion.transpose();
    }
    Vector3<Scalar> position = at_node(unmoved_, contact.node);
    if (contact.body >= 0) {
      position -= motion_at(bodies_[at(contact.body)].unmoved, contact.lever_arm);
    }
    const Scalar gap = contact.normal.dot(position) - contact.offset;
    if (gap < 0) unmoved_.row(contact.node) -= gap * contact.normal.transpose();
  }
}

// Enforces that the solution has no more energy than the start of the step, as the exact one does. If it has more, iterations
// continue with the stiffest linearization, whose steps always decrease the energy (as the global step of Bouaziz et al.
// 2014). Changing contact states may defeat that, so the last resort is a backtracking line search towards the start.
template <class Scalar>
void ImplicitSolver<Scalar>::enforce_descent(const StepProblem<Scalar>& problem, int iterations) {
  stay_at_start(problem);
  const double slack = kRoundingShare * step_energy_;
  const double most = energy(problem, unmoved_, &Body::unmoved) + slack;
  const double reached = energy(problem, positions_, &Body::motion);
  if (reached <= most) return;
  report_.is_converged = false;
  report_.energy_left = std::max(report_.energy_left, std::min(reached - most, step_energy_));
  const auto goes_up = [&] { return !(energy(problem, positions_, &Body::motion) <= most); };
  if (!(reached <= most + kFarUp * step_energy_)) restore_start();
  forces_.set_least_transverse_stiffness(1);
  evaluate();
  for (int iteration = 0; iteration < kSafeIterations; ++iteration) {
    iterate_once(problem, {.iterations = iterations, .is_cautious = true, .factorizes = true});
    if (!goes_up()) break;
  }
  forces_.set_least_transverse_stiffness(0);
  for (int halving = 0; goes_up(); ++halving) {
    if (halving == kHalvings) {
      restore_start();
      break;
    }
    positions_ = Scalar(0.5) * (positions_ + unmoved_);
    for (Body& body : bodies_) body.motion = Scalar(0.5) * (body.motion + body.unmoved);
  }
  evaluate();
}

template <class Scalar>
void ImplicitSolver<Scalar>::restore_start() {
  positions_ = unmoved_;
  for (Body& body : bodies_) body.motion = body.unmoved;
}

// Net-momentum correction. The residual that conjugate gradients leave would push the cloth, and the bodies attached to it, as
// a whole. If nothing fixed constrains them, a rigid shift removes that, because no spring feels it. If something does, the net
// residual is no error of the whole body's motion, and there is no correction.
template <class Scalar>
std::optional<Vector3<Scalar>> ImplicitSolver<Scalar>::net_momentum_correction(
    const StepProblem<Scalar>& problem) {
  if (!pinned_.empty() || links_.size() != constrained_.size()) return std::nullopt;
  if (!supports_.empty()) return std::nullopt;
  for (const Body& body : bodies_) {
    if (body.is_linked && body.is_held) return std::nullopt;
  }
  const auto sum = sum_over_parts<Eigen::Vector4d>([&](NodeRange nodes) {  // of forces, of inertia
    const int count = nodes.end - nodes.begin;
    Eigen::Vector4d part;
    part << residual_forces_.middleRows(nodes.begin, count)
                .template cast<double>()
                .colwise()
                .sum()
                .transpose(),
        inertia_.segment(nodes.begin, count).template cast<double>().sum();
    return part;
  });
  Vector3<double> left = sum.template head<3>();
  Vector3<double> inertia = Vector3<double>::Constant(sum[3]);
  for (const Body& body : bodies_) {
    if (!body.is_linked) continue;
    const Vector3<double> of_body =
        body.inertia.diagonal().template head<3>().template cast<double>();
    inertia += of_body;
    left -= of_body.cwiseProduct(body.motion.template head<3>().template cast<double>());
  }
  const bool has_links =
      std::any_of(bodies_.begin(), bodies_.end(), [](const Body& body) { return body.is_link; });
  const Vector3<Scalar> shift =
      (has_links ? couplings_.shift(bodies_, sum.template head<3>(), sum[3])
                 : left.cwiseQuotient(inertia).eval())
          .template cast<Scalar>();
  // A step that was taken back has left over what planes would have held.
  for (const PlaneContact<Scalar>& contact : problem.contacts) {
    if (contact.body >= 0 && bodies_[at(contact.body)].is_linked) continue;
    const Vector3<Scalar> position = at_node(positions_, contact.node) + shift;
    if (contact.normal.dot(position) < contact.offset) return std::nullopt;
  }
  for (Body& body : bodies_) {
    if (body.is_linked) body.motion.template head<3>() += shift;
  }
  return shift;
}

#ifndef WEFT_SOLVER_IS_ONE_UNIT
template class ImplicitSolver<float>;
template class ImplicitSolver<double>;
#endif

}  // namespace weft::fast
