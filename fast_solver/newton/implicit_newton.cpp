// Newton's method on the energy that an implicit step minimises (Gast et al. 2015), with a line search on it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
/// Rounds whose shrinking tells how much the last one may have left.
constexpr std::size_t kShrinksSeen = 4;
/// From this share of the gain of the round before on, so many times, a round gains rounding only.
constexpr double kStalled = 0.9;
constexpr int kMostStalled = 3;
/// Least stiffness across a spring over that along it, after a round that has gained energy, and how it grows if that was not
/// enough: with 1 no round gains any.
constexpr double kFirstAcross = 0.02;
constexpr double kMoreAcross = 7;
/// The share of an energy that is rounding [-].
constexpr double kEnergyRounding = 2e-7;
/// There is no more to be gained than so many times what places gain by their rounding alone [-].
constexpr double kRoundings = 4;
/// A single iteration may leave this share of the gain that is asked for [-].
constexpr double kLastShare = 0.02;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

template <class Scalar>
void ImplicitSolver<Scalar>::do_round(const StepProblem<Scalar>& problem,
                                      const NewtonRound& round) {
  if (round.decides) {
    decide_holds(problem, round);
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
  std::array<double, kShrinksSeen> last_shrinks{};
  double across = 0;
  double rounding = 0;
  int num_stalled = 0;
  int num_decisions = 0;
  bool decides = true;
  report_ = {.is_converged = false};
  anderson_.forget();
  for (int round = 0; round < effort.rounds && !report_.is_converged; ++round) {
    report_.rounds = round + 1;
    remember_places();
    do_round(problem, {.iterations = effort.iterations,
                       .is_first = round == 0,
                       .decides = decides,
                       .continues = problem.continues,
                       .factorises = round % kRoundsPerFactor == 0,
                       .least_gain = kLastShare * asked});
    if (decides) ++num_decisions;
    if (round == 0) rounding = kRoundings * gain_of_rounding();
    const bool are_holds_new = decides && (round == 0 || have_holds_changed_);
    const double now = energy(problem, places_, &Body::motion);
    if (!are_holds_new && !(now <= energy_before * (1 + kEnergyRounding) + asked)) {
      if (across == 1) {
        // With this linearisation every spring gains. What is left is rounding, if that is all that the step could have gained.
        recall_places();
        const double least = std::max({rounding, asked, kEnergyRounding * std::abs(energy_before)});
        const bool is_decided = !has_contacts || num_decisions >= kMostDecisions;
        report_.is_converged = is_decided && !last_gain_.is_broken && last_gain_.total <= least;
        break;
      }
      across = std::min(1.0, std::max(kFirstAcross, kMoreAcross * across));
      forces_.set_least_across(static_cast<Scalar>(across));
      recall_places();
      anderson_.forget();
      decides = false;
      continue;
    }
    energy_before = now;
    across = across > kFirstAcross ? across / kMoreAcross : 0.0;
    forces_.set_least_across(static_cast<Scalar>(across));
    const double shrinks = before > 0 ? last_gain_.total / before : kFirstShrink;
    const double limited = std::min(kSlowest, shrinks);
    const double left = last_gain_.left + last_gain_.total * limited / (1 - limited);
    // Accelerated rounds gain little now and then, with some way to go. That is known here, but too late to stop by.
    last_shrinks[at(round) % last_shrinks.size()] = shrinks;
    const double slowest =
        std::min(kSlowest, *std::max_element(last_shrinks.begin(), last_shrinks.end()));
    report_.energy_left = last_gain_.is_broken
                              ? step_energy_
                              : (last_gain_.left + last_gain_.total * slowest / (1 - slowest)) / 2;
    num_stalled = !are_holds_new && !(shrinks < kStalled) ? num_stalled + 1 : 0;
    // What is stiff goes on to gain by rounding alone, while what is soft may have some way to go.
    const bool is_rounding = last_gain_.total <= rounding && !(shrinks < kStalled);
    const bool is_solved = (left <= asked || is_rounding) && !last_gain_.is_broken;
    const bool is_over = is_solved || (num_stalled >= kMostStalled && effort.tolerance > 0);
    // With these contacts. Whether they are the right ones is asked of a solution: on the way there forces say little.
    const bool can_decide = has_contacts && num_decisions < kMostDecisions;
    report_.is_converged =
        is_solved && (!has_contacts || (decides && !are_holds_new) || !can_decide);
    if (is_over && !report_.is_converged && !can_decide) break;
    decides = can_decide && ((round < kFirstDecisions && !problem.continues) || is_over);
    if (decides) num_stalled = 0;
    before = last_gain_.total;
    if (are_holds_new) {
      anderson_.forget();
    } else if (!report_.is_converged && round + 1 < effort.rounds) {
      energy_before = accelerate(problem, now);
    }
  }
  forces_.set_least_across(0);
}

// Goes on to the combination of the last rounds, if that has less energy than the last one has reached. Returns the energy then.
template <class Scalar>
double ImplicitSolver<Scalar>::accelerate(const StepProblem<Scalar>& problem, double reached) {
  using Products = typename AndersonHistory<Scalar>::Products;
  anderson_.next();
  const Products products = sum_over_parts<Products>([this](NodeRange nodes) {
    const Products of_part = anderson_.add(nodes, last_places_, places_, last_results_);
    const int count = nodes.end - nodes.begin;
    last_results_.middleRows(nodes.begin, count) = places_.middleRows(nodes.begin, count);
    return of_part;
  });
  for (Body& body : bodies_) {
    if (anderson_.has_last()) {
      body.result_changes[at(anderson_.newest())] = body.motion - body.last_result;
    }
    body.last_result = body.motion;
  }
  anderson_.added();
  if (anderson_.count() == 0) return reached;
  const typename AndersonHistory<Scalar>::Weights weights = anderson_.weights(products);
  for_each_part([this, weights](NodeRange nodes) { anderson_.combine(nodes, weights, places_); });
  for (Body& body : bodies_) {
    for (int k = 0; k < anderson_.count(); ++k) {
      body.motion -= static_cast<Scalar>(weights[k]) * body.result_changes[at(k)];
    }
  }
  const double combined = energy(problem, places_, &Body::motion);
  if (combined <= reached) {
    evaluate();
    return combined;
  }
  places_ = last_results_;
  for (Body& body : bodies_) body.motion = body.last_result;
  return reached;
}

/// What a round would gain if places were exact but for their last digit [J], twice an energy as LinearGain.
template <class Scalar>
double ImplicitSolver<Scalar>::gain_of_rounding() {
  constexpr double kVariance = 1.0 / 12;  // of numbers rounded to whole ones
  constexpr double kUnit = std::numeric_limits<Scalar>::epsilon();
  const BlockArrays& blocks = forces_.diagonal_blocks();
  return kVariance * kUnit * kUnit * sum_over_parts([&](NodeRange nodes) {
           const int count = nodes.end - nodes.begin;
           double sum = 0;
           for (int axis = 0; axis < 3; ++axis) {
             const auto stiffness = blocks.col(axis).segment(nodes.begin, count) +
                                    inertia_.segment(nodes.begin, count);
             const auto places = places_.col(axis).segment(nodes.begin, count);
             sum += static_cast<double>(places.cwiseAbs2().template cast<float>().dot(stiffness));
           }
           return sum;
         });
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
