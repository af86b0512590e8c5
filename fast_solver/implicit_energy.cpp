// What keeps a step from gaining energy or momentum, however badly it has converged.
#include <algorithm>

#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::fast {
namespace {

/// Of a step that is taken at least.
constexpr double kSmallestShare = 0.1;
/// Squared motion of a step over that without springs from which on its energy is looked at.
constexpr double kMostMotion = 1.2;
/// Work that left-over forces could do, over the energy of the motion without springs, from which on likewise.
constexpr double kMostWork = 1.0;
/// Of that energy, what rounding may make of a step that changes nothing.
constexpr double kRoundingShare = 0.01;
/// Rounds of a step that would have gained energy, and halvings of each of them.
constexpr int kExtraRounds = 6;
constexpr int kHalvings = 6;
/// Of the energy of the motion without springs: what a round must take away for another one to follow.
constexpr double kLastDescent = 1e-4;
constexpr int kExtraIterations = 4;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

// A linearisation may promise too much where springs turn far in one step. The work of the forces
// that are left tells: if it opposes the step by more than half of what drove it, back to where a
// straight line between the two is zero.
template <class Scalar>
bool ImplicitSolver<Scalar>::hold_back(double work_before, std::size_t num_held) {
  const double work_after = work_left_ - work_of_held(num_held) + work_of_bodies();
  if (!(work_before > 0 && work_after < -0.5 * work_before)) return false;
  const double share = std::max(kSmallestShare, work_before / (work_before - work_after));
  const auto excess = static_cast<Scalar>(1.0 - share);
  // What the whole step has led to a plane may not come to it on a part of the way.
  for (std::size_t k = num_held; k < held_.size(); ++k) {
    holds_[at(held_[k])] = Hold::kFree;
    contact_of_[at(held_[k])] = -1;
  }
  held_.resize(num_held);
  for (const int i : held_) step_.row(i).setZero();
  add_motions(&Body::step, step_);
  move_bodies(-excess);
  places_ -= excess * step_.template cast<Scalar>();
  return true;
}

template <class Scalar>
typename ImplicitSolver<Scalar>::Energy ImplicitSolver<Scalar>::energy_of(
    NodeRange nodes, const Nodes& places) const {
  const double of_springs = forces_.potential(nodes, places);
  const double squares = sum_kernel<Scalar>().weighted_distance(
      weights_.data(), static_cast<int>(weights_.size()), nodes, places.data(), targets_.data());
  return {of_springs + 0.5 * squares, of_springs};
}

// What an implicit step minimises [J], with the bodies that give way to it and with what friction does.
template <class Scalar>
typename ImplicitSolver<Scalar>::Energy ImplicitSolver<Scalar>::energy(
    const StepProblem<Scalar>& problem, const Nodes& places, Vector6 Body::*motion) {
  auto sum = sum_over_parts<Energy>([&](NodeRange nodes) { return energy_of(nodes, places); });
  add_energy_of_holds(problem, places, motion, sum);
  return sum;
}

template <class Scalar>
void ImplicitSolver<Scalar>::add_energy_of_holds(const StepProblem<Scalar>& problem,
                                                 const Nodes& places, Vector6 Body::*motion,
                                                 Energy& energy) const {
  double& sum = energy.total;
  for (const Body& body : bodies_) {
    const Vector6& way = body.*motion;
    sum += 0.5 * static_cast<double>(way.dot(body.inertia.template cast<Scalar>() * way));
  }
  for (const int i : held_) {
    if (contact_of_[at(i)] < 0) continue;
    // A surface that is led may do work by friction; slip only takes it away.
    const PlaneContact<Scalar>& contact = problem.contacts[at(contact_of_[at(i)])];
    const Vector3<Scalar> friction = friction_.col(i).template cast<Scalar>();
    Vector3<Scalar> slip = at_node(places, i) - at_node(starts_, i) - contact.motion;
    if (contact.body >= 0) {
      slip -= motion_at(bodies_[at(contact.body)].*motion, contact.arm);
    } else {
      sum -= static_cast<double>(friction.dot(contact.motion));
    }
    sum -= static_cast<double>(std::min(Scalar(0), friction.dot(slip)));
  }
}

// A contact may have stretched springs; without one, more motion than without springs, or forces that are left over
// and could do as much work as the step's motion is worth: springs may have pulled, or the solution may be off.
template <class Scalar>
bool ImplicitSolver<Scalar>::is_suspicious(const StepProblem<Scalar>& problem) {
  if (!held_.empty()) return true;
  const auto stride = static_cast<int>(masses_.size());
  const SumKernel<Scalar>& sums = sum_kernel<Scalar>();
  const auto sum = sum_over_parts<Eigen::Array2d>([&](NodeRange nodes) {
    return Eigen::Array2d(
        sums.weighted_distance(masses_.data(), stride, nodes, places_.data(), starts_.data()),
        sums.possible_work(stride, nodes, places_.data(), starts_.data(), unbalanced_.data()));
  });
  const double moved = sum[0];
  const double left = sum[1];
  const auto h = static_cast<double>(problem.inertia_step);
  return !(moved <= 2 * h * h * kMostMotion * step_energy_ && left <= kMostWork * step_energy_);
}

// Where nothing has moved but what is led, in front of all planes.
template <class Scalar>
bool ImplicitSolver<Scalar>::stay_at_start(const StepProblem<Scalar>& problem) {
  for_each_part([&](NodeRange nodes) {
    const int count = nodes.end - nodes.begin;
    unmoved_.middleRows(nodes.begin, count) = starts_.middleRows(nodes.begin, count);
  });
  bool is_unmoved = problem.led.empty();
  const auto put = [&](int node, const auto& place) {
    is_unmoved = is_unmoved && unmoved_.row(node) == place;
    unmoved_.row(node) = place;
  };
  for (const int node : pinned_) put(node, targets_.row(node));
  for (Body& body : bodies_) {
    body.unmoved = body.is_linked ? Vector6(-body.motion_alone) : Vector6(Vector6::Zero());
  }
  for (const LedNode<Scalar>& led : problem.led) {
    Vector3<Scalar> place = led.place;
    if (led.body >= 0) place += motion_at(bodies_[at(led.body)].unmoved, led.arm);
    unmoved_.row(led.node) = place.transpose();
  }
  for (const PlaneContact<Scalar>& contact : problem.contacts) {
    if (!is_free_[at(contact.node)] || contact.body >= 0) continue;
    if (holds_[at(contact.node)] == Hold::kFixed) {
      put(contact.node, (starts_.row(contact.node) + contact.motion.transpose()).eval());
    }
    const Scalar gap = contact.normal.dot(at_node(unmoved_, contact.node)) - contact.offset;
    if (gap >= 0) continue;
    unmoved_.row(contact.node) -= gap * contact.normal.transpose();
    is_unmoved = false;
  }
  return is_unmoved;
}

// Back towards where nothing has moved, until there is no more energy than there.
template <class Scalar>
bool ImplicitSolver<Scalar>::descend(const StepProblem<Scalar>& problem) {
  const double most = energy(problem, unmoved_, &Body::unmoved).total;
  for (int halvings = 0; halvings <= kHalvings; ++halvings) {
    if (energy(problem, places_, &Body::motion).total <= most) {
      if (halvings > 0) evaluate();
      return true;
    }
    places_ = Scalar(0.5) * (places_ + unmoved_);
    for (Body& body : bodies_) body.motion = Scalar(0.5) * (body.motion + body.unmoved);
  }
  return false;
}

template <class Scalar>
void ImplicitSolver<Scalar>::go_back() {
  places_ = unmoved_;
  for (Body& body : bodies_) body.motion = body.unmoved;
}

// Newton's method from the start of the step, each round downhill. False if none was.
template <class Scalar>
bool ImplicitSolver<Scalar>::go_downhill(const StepProblem<Scalar>& problem, int iterations) {
  go_back();
  evaluate();
  bool is_careful = false;
  bool went_down = false;
  for (int round = 0; round < kExtraRounds; ++round) {
    do_round(problem,
             {.iterations = kExtraIterations * iterations, .factorises = round == 0 || is_careful});
    const double before = energy(problem, unmoved_, &Body::unmoved).total;
    const bool goes_down = descend(problem);
    if (goes_down) {
      unmoved_ = places_;
      for (Body& body : bodies_) body.unmoved = body.motion;
      went_down = true;
      const double after = energy(problem, places_, &Body::motion).total;
      if (before - after <= kLastDescent * step_energy_) break;
    }
    if (!goes_down && is_careful) break;
    // Slack springs resist nothing across in a linearisation, and all the more once they have turned.
    is_careful = !goes_down;
    forces_.set_least_across(is_careful ? Scalar(1) : Scalar(0));
    if (!goes_down) {
      go_back();
      evaluate();
    }
  }
  go_back();
  forces_.set_least_across(0);
  evaluate();
  return went_down;
}

// The exact solution has no more of the energy that it minimises than the places at the start. One
// that has is thrown away: Newton's method starts there once more, and now each of its steps must go
// downhill. So an implicit step gains no energy, however badly its linear systems are solved.
//
// Friction follows from the force that holds a node. Where springs are some 10^5 times stiffer than
// inertia, that is rounding: if nothing goes downhill with it, what does without.
template <class Scalar>
void ImplicitSolver<Scalar>::tame(const StepProblem<Scalar>& problem, int iterations) {
  const bool is_unmoved = stay_at_start(problem);
  struct Both {
    Energy before;
    Energy after;
    Both operator+(const Both& other) const { return {before + other.before, after + other.after}; }
  };
  auto [before, after] = sum_over_parts<Both>([&](NodeRange nodes) {
    return Both{energy_of(nodes, unmoved_), energy_of(nodes, places_)};
  });
  add_energy_of_holds(problem, unmoved_, &Body::unmoved, before);
  add_energy_of_holds(problem, places_, &Body::motion, after);
  if (is_unmoved) known_.before = before.of_springs;
  if (after.total <= before.total + kRoundingShare * step_energy_) {
    known_.after = after.of_springs;
    return;
  }
  if (go_downhill(problem, iterations)) return;
  // What springs will hold back would be held by a plane that it would reach without them.
  std::fill(holds_.begin(), holds_.end(), Hold::kFree);
  if (go_downhill(problem, iterations)) return;
  has_friction_ = false;
  std::fill(holds_.begin(), holds_.end(), Hold::kFree);
  (void)go_downhill(problem, iterations);
  has_friction_ = true;
}

// What conjugate gradients have left over would push the cloth, and the bodies that hang on it, as a whole.
// Where nothing immovable holds it, a shift of all nodes, which no spring feels, takes that away to
// rounding. Where something does, what is left over is no error of the whole body's: in a stiff sheet a
// micrometre is worth many newtons.
template <class Scalar>
std::optional<Vector3<Scalar>> ImplicitSolver<Scalar>::find_balance(
    const StepProblem<Scalar>& problem) {
  if (!pinned_.empty() || links_.size() != held_.size()) return std::nullopt;
  for (const Body& body : bodies_) {
    if (body.is_linked && body.is_held) return std::nullopt;
  }
  const auto sum = sum_over_parts<Eigen::Vector4d>([&](NodeRange nodes) {  // of forces, of inertia
    const int count = nodes.end - nodes.begin;
    Eigen::Vector4d part;
    part << unbalanced_.middleRows(nodes.begin, count)
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
  const Vector3<Scalar> shift = left.cwiseQuotient(inertia).template cast<Scalar>();
  // A step that was taken back has left over what planes would have held.
  for (const PlaneContact<Scalar>& contact : problem.contacts) {
    if (contact.body >= 0 && bodies_[at(contact.body)].is_linked) continue;
    const Vector3<Scalar> place = at_node(places_, contact.node) + shift;
    if (contact.normal.dot(place) < contact.offset) return std::nullopt;
  }
  for (Body& body : bodies_) {
    if (body.is_linked) body.motion.template head<3>() += shift;
  }
  return shift;
}

template class ImplicitSolver<float>;
template class ImplicitSolver<double>;

}  // namespace weft::fast
