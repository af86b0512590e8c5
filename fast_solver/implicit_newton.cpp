// Newton's method on the energy that an implicit step minimises (Gast et al. 2015), with a line search on it.
#include <algorithm>

#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::fast {
namespace {

/// Rounds after which the coarse correction is made anew, for the linearisation as it is then.
constexpr int kRoundsPerFactor = 4;
/// How often in a step contacts are decided: in its first rounds, where most of them are found out, and of a solution.
constexpr int kFirstDecisions = 2;
constexpr int kMostDecisions = 8;
/// How much a round's gain is of that of the one before: assumed of the first, and at most.
constexpr double kFirstShrink = 0.1;
constexpr double kSlowest = 0.9;
/// From this share of the gain of the round before on, so many times, a round gains rounding only.
constexpr double kStalled = 0.9;
constexpr int kMostStalled = 3;
/// Least stiffness across a spring over that along it, after a round that has gained energy, and how it grows if that was not
/// enough: with 1 no round gains any.
constexpr double kFirstAcross = 0.02;
constexpr double kMoreAcross = 7;
/// Of an energy.
constexpr double kEnergyRounding = 2e-7;
/// Of the gain that is asked for: what a single iteration may leave.
constexpr double kLastShare = 0.02;

}  // namespace

template <class Scalar>
void ImplicitSolver<Scalar>::do_round(const StepProblem<Scalar>& problem,
                                      const NewtonRound& round) {
  if (round.decides) {
    decide_holds(problem, round.is_first);
  } else {
    list_held();
    update_friction(problem);
  }
  set_system_inertia();
  if (round.is_first || round.factorises) {
    const Scalar squared_step = problem.inertia_step * problem.inertia_step;
    forces_.factorise(coarse_correction_, holds_, static_cast<float>(1 / squared_step), *team_);
  }
  last_gain_ = solve_linear(problem, round.iterations, round.least_gain);
  const double of_bodies = work_of_bodies();
  move();
  const std::size_t num_held = held_.size();
  const double of_others = of_bodies - work_of_held(num_held);
  clamp(problem);
  evaluate(round.linearises);
  if (!hold_back(work_done_ + of_others, num_held)) return;
  clamp(problem);
  evaluate(round.linearises);
}

// Newton's method until what is left to gain is less than asked for, or no more than rounding.
template <class Scalar>
void ImplicitSolver<Scalar>::iterate(const StepProblem<Scalar>& problem,
                                     const SolverEffort& effort) {
  const bool has_contacts = !problem.contacts.empty();
  const double asked = 2 * effort.tolerance * effort.tolerance * step_energy_;
  double before = 0;
  double energy_before = 0;
  double across = 0;
  int num_stalled = 0;
  int num_decisions = 0;
  bool decides = true;
  is_converged_ = false;
  for (int round = 0; round < effort.rounds && !is_converged_; ++round) {
    remember_places();
    do_round(problem, {.iterations = effort.iterations,
                       .is_first = round == 0,
                       .decides = decides,
                       .factorises = round % kRoundsPerFactor == 0,
                       .least_gain = kLastShare * asked});
    if (decides) ++num_decisions;
    const bool are_holds_new = decides && (round == 0 || have_holds_changed_);
    const double now = energy(problem, places_, &Body::motion);
    if (!are_holds_new && !(now <= energy_before * (1 + kEnergyRounding) + asked)) {
      if (across == 1) {
        recall_places();
        break;  // rounding
      }
      across = std::min(1.0, std::max(kFirstAcross, kMoreAcross * across));
      forces_.set_least_across(static_cast<Scalar>(across));
      recall_places();
      decides = false;
      continue;
    }
    energy_before = now;
    across = across > kFirstAcross ? across / kMoreAcross : 0.0;
    forces_.set_least_across(static_cast<Scalar>(across));
    const double shrinks = before > 0 ? last_gain_.total / before : kFirstShrink;
    const double limited = std::min(kSlowest, shrinks);
    const double left = last_gain_.left + last_gain_.total * limited / (1 - limited);
    num_stalled = !are_holds_new && !(shrinks < kStalled) ? num_stalled + 1 : 0;
    const bool is_solved = left <= asked && !last_gain_.is_broken;
    const bool is_over = is_solved || (num_stalled >= kMostStalled && effort.tolerance > 0);
    // With these contacts. Whether they are the right ones is asked of a solution: on the way there forces say little.
    const bool can_decide = has_contacts && num_decisions < kMostDecisions;
    is_converged_ = is_solved && (!has_contacts || (decides && !are_holds_new) || !can_decide);
    if (is_over && !is_converged_ && !can_decide) break;
    decides = can_decide && (round < kFirstDecisions || is_over);
    if (decides) num_stalled = 0;
    before = last_gain_.total;
  }
  forces_.set_least_across(0);
}

template <class Scalar>
void ImplicitSolver<Scalar>::remember_places() {
  for_each_part([this](NodeRange nodes) {
    const int count = nodes.end - nodes.begin;
    last_places_.middleRows(nodes.begin, count) = places_.middleRows(nodes.begin, count);
  });
  for (Body& body : bodies_) body.last_motion = body.motion;
}

template <class Scalar>
void ImplicitSolver<Scalar>::recall_places() {
  places_ = last_places_;
  for (Body& body : bodies_) body.motion = body.last_motion;
  evaluate();
}

template class ImplicitSolver<float>;
template class ImplicitSolver<double>;

}  // namespace weft::fast
