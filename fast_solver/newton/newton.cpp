// Newton's method on the energy that an implicit step minimizes (Gast et al. 2015), with a line search on it.
// Tested by tests/fast_solver/implicit_solver_test.cpp.
#include <algorithm>
#include <cmath>

#include <weft/fast_solver/implicit_solver.hpp>
#include <weft/fast_solver/newton/contact_decisions.hpp>
#include <weft/fast_solver/newton/node_stiffness.hpp>
#include <weft/fast_solver/newton/stop_criterion.hpp>
#include <weft/fast_solver/newton/transverse_stiffness.hpp>

#include <weft/core/index.hpp>

namespace weft::fast {
namespace {

/// The coarse matrix is factorized again after so many iterations.
constexpr int kIterationsPerFactor = 4;
/// The share of an energy that is rounding [-]. In contact with what nothing moves there is more of it, of what nodes press with and
/// the last digits of their heights: gains of less than kEnergyDoubt are judged by the slopes at both ends (Hager and Zhang 2005).
/// Not so on bodies: between fingers friction gives way by what rounding would excuse.
constexpr double kEnergyRounding = 2e-7;
constexpr double kEnergyDoubt = 1e-6;
constexpr double kSteepestRise = -0.5;
/// In contact rounding gains so many times as much as without, for heights above planes are rounded too [-].
constexpr double kRoundingOfHeights = 3;
/// An iteration that gains at most so many times what may be left is close to the solution, and may be lengthened in contact with what
/// nothing moves. Without contacts as many steps are solved without that, and their estimated errors are more often right [-].
constexpr double kCloseBy = 100;
/// The share of an energy that a step without motion is held against [-].
constexpr double kAtRest = 0.01;
constexpr double kAtRestInContact = 0.3;

}  // namespace

template <class Scalar>
void ImplicitSolver<Scalar>::iterate_once(const StepProblem<Scalar>& problem,
                                          const NewtonIteration& iteration) {
  save_positions();
  if (iteration.decides) {
    decide_contact_states(problem, iteration);
    // It gives friction other bounds: with these the energy before counts too.
    if (!iteration.is_first && !problem.contacts.empty())
      energy_before_ = energy(problem, positions_, &Body::motion);
  } else {
    list_constrained();
    update_friction(problem, iteration.is_cautious);
  }
  if (!supports_.empty()) update_supports(problem, iteration);
  set_system_inertia();
  find_coarse_roles();
  if (iteration.is_first || iteration.factorizes) {
    const Scalar squared_step = problem.inertia_step * problem.inertia_step;
    forces_.factorize(coarse_correction_, coarse_roles_.is_held(), coarse_roles_.sliding(),
                      static_cast<float>(1 / squared_step), *team_);
  }
  last_gain_ = solve_linear(problem, iteration);
  const double of_bodies = work_of_bodies();
  move();
  const std::size_t num_constrained = constrained_.size();
  const double work = work_done_ + of_bodies - work_of_constraints(problem, last_positions_);
  evaluate(iteration.linearizes);
  // The linear model knows nothing of planes that it has not met: it is judged before nodes are put in front of them.
  const bool is_shorter = line_search(problem, iteration, work);
  clamp(problem);
  has_met_planes_ = constrained_.size() > num_constrained;
  if (is_shorter || was_clamped_) evaluate(iteration.linearizes);
}

// Newton's method until what is left to gain is below the tolerance or is rounding.
template <class Scalar>
void ImplicitSolver<Scalar>::iterate(const StepProblem<Scalar>& problem,
                                     const SolverSettings& solver_settings) {
  const bool has_contacts = !problem.contacts.empty();
  const bool is_on_fixed = has_contacts && bodies_.empty();
  const double squared_tolerance = solver_settings.tolerance * solver_settings.tolerance;
  const double asked = squared_tolerance * 2 * step_energy_;
  double wanted = squared_tolerance * motion_that_counts(has_contacts);
  StopCriterion stop;
  ContactDecisions decisions(has_contacts, !supports_.empty(), problem.continues);
  energy_before_ = 0;
  TransverseStiffness transverse;
  bool is_within = false;
  report_ = {.is_converged = false};
  anderson_.forget();
  for (int iteration = 0; iteration < solver_settings.newton_iterations && !report_.is_converged;
       ++iteration) {
    report_.newton_iterations = iteration + 1;
    iterate_once(problem,
                 {.iterations = solver_settings.linear_iterations,
                  .accuracy = accuracy_of(iteration, has_contacts, !bodies_.empty(), wanted),
                  .most_to_lengthen = is_on_fixed ? kCloseBy * wanted : 0,
                  .is_first = iteration == 0,
                  .decides = decisions.decides(),
                  .continues = problem.continues,
                  .is_cautious = transverse.is_raised(),
                  .factorizes = iteration % kIterationsPerFactor == 0});
    if (iteration == 0 || has_contacts) stop.set_rounding(gain_of_rounding_now(is_on_fixed));
    const bool are_contact_states_new =
        has_met_planes_ ||
        (decisions.decides() && (iteration == 0 || have_contact_states_changed_));
    decisions.add(iteration == 0, are_contact_states_new);
    double now = energy(problem, positions_, &Body::motion);
    const bool is_rounding = !last_gain_.is_broken && last_gain_.total <= stop.most_of_rounding();
    const bool is_doubtful = is_on_fixed && last_gain_.slope_left > kSteepestRise &&
                             last_gain_.total <= kEnergyDoubt * std::abs(energy_before_);
    const double noise = (is_doubtful ? kEnergyDoubt : kEnergyRounding) * energy_before_ +
                         (is_rounding ? stop.most_of_rounding() : stop.rounding());
    const double most = energy_before_ + asked + noise;
    if (!are_contact_states_new) now = shorten_bending(problem, now, most);
    if (!are_contact_states_new && !(now <= most)) {
      const bool is_stiffest = !step_forces_.follow() && !transverse.raise();
      forces_.set_least_transverse_stiffness(static_cast<Scalar>(transverse.share()));
      restore_positions();  // with the linearization of the repetition
      anderson_.forget();
      if (is_stiffest) {
        // With this linearization every spring gains. What is left is rounding, if that is all that the step could have gained.
        const double least =
            std::max({stop.most_of_rounding(), asked, kEnergyRounding * std::abs(energy_before_)});
        if (last_gain_.is_broken || last_gain_.total > least) break;
        report_.is_converged = decisions.are_settled();
        stop.forget_stalls();
      }
      decisions.decide_next(is_stiffest);
      continue;
    }
    wanted = squared_tolerance * motion_that_counts(has_contacts);
    stop.add(last_gain_, has_contacts ? 0 : energy_before_ - now, are_contact_states_new);
    energy_before_ = now;
    transverse.lower();
    forces_.set_least_transverse_stiffness(static_cast<Scalar>(transverse.share()));
    report_.energy_left = last_gain_.is_broken ? step_energy_ : stop.energy_left();
    const bool is_solved = stop.is_solved(wanted);
    const bool is_over = is_solved || (stop.is_stalled() && solver_settings.tolerance > 0);
    report_.is_converged = is_solved && decisions.are_confirmed(are_contact_states_new);
    is_within = stop.is_within(asked) && decisions.are_settled();
    if (is_over && !report_.is_converged && !decisions.can_decide()) break;
    decisions.plan(iteration, last_gain_.total, is_over, has_met_planes_);
    if (decisions.decides()) stop.forget_stalls();
    const bool is_followed_now = last_gain_.slope_left < kSteepestRise && step_forces_.follow();
    if (is_followed_now) evaluate();
    if (are_contact_states_new || is_followed_now || was_lengthened_) {
      anderson_.forget();
    } else if (!report_.is_converged && iteration + 1 < solver_settings.newton_iterations) {
      energy_before_ = accelerate(problem, now);
    }
  }
  report_.is_converged = report_.is_converged || is_within;
  forces_.set_least_transverse_stiffness(0);
}

// The drag of nodes that hardly slip is many times as stiff as springs, so that rounding gains more there.
template <class Scalar>
double ImplicitSolver<Scalar>::gain_of_rounding_now(bool is_on_fixed) {
  const double gain = sum_over_parts([this](NodeRange nodes) {
    return gain_of_rounding<Scalar>(nodes, forces_.diagonal_blocks(), system_inertia_, positions_);
  });
  return is_on_fixed ? kRoundingOfHeights * gain : gain;
}

// Twice the energy of the motion that the tolerance is a share of [J]: that of the step, m |x - q|^2 / (2 h'^2). Where cloth
// rests it is a share of that without springs, m |y - q|^2 / (2 h'^2): with all of it, stiff springs could keep several weights
// of a node. If the budget ends before, all of it is enough for the step to count as solved.
template <class Scalar>
double ImplicitSolver<Scalar>::motion_that_counts(bool has_contacts) {
  const auto stride = static_cast<int>(weights_.size());
  const double squares = sum_over_parts([&](NodeRange nodes) {
    return sum_kernel<Scalar>().weighted_distance(weights_.data(), stride, nodes, positions_.data(),
                                                  start_positions_.data());
  });
  const double least = has_contacts ? kAtRestInContact : kAtRest;
  return std::clamp(squares, least * 2 * step_energy_, 2 * step_energy_);
}

// Continues from the Anderson combination of the last iterations if it has no more energy than the last result, on what does not give
// way beside rounding: the differences of the last iterations are smaller than that. Returns the energy of the positions that are kept.
template <class Scalar>
double ImplicitSolver<Scalar>::accelerate(const StepProblem<Scalar>& problem, double reached) {
  using Products = typename AndersonHistory<Scalar>::Products;
  anderson_.next();
  const Products products = sum_over_parts<Products>([this](NodeRange nodes) {
    Products of_part = anderson_.add(nodes, last_positions_, positions_, last_results_);
    const int count = nodes.end - nodes.begin;
    last_results_.middleRows(nodes.begin, count) = positions_.middleRows(nodes.begin, count);
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
  for_each_part(
      [this, weights](NodeRange nodes) { anderson_.combine(nodes, weights, positions_); });
  for (Body& body : bodies_) {
    for (int k = 0; k < anderson_.count(); ++k) {
      body.motion -= static_cast<Scalar>(weights[k]) * body.result_changes[at(k)];
    }
  }
  put_in_front(problem);  // for combinations may lie behind planes, with less energy for that
  const double combined = energy(problem, positions_, &Body::motion);
  if (combined <= reached + (bodies_.empty() ? kEnergyRounding * std::abs(reached) : 0.0)) {
    evaluate();
    return combined;
  }
  positions_ = last_results_;
  for (Body& body : bodies_) body.motion = body.last_result;
  return reached;
}

template <class Scalar>
void ImplicitSolver<Scalar>::save_positions() {
  for_each_part([this](NodeRange nodes) {
    const int count = nodes.end - nodes.begin;
    last_positions_.middleRows(nodes.begin, count) = positions_.middleRows(nodes.begin, count);
  });
  for (Body& body : bodies_) body.last_motion = body.motion;
}

template <class Scalar>
void ImplicitSolver<Scalar>::restore_positions() {
  positions_ = last_positions_;
  for (Body& body : bodies_) body.motion = body.last_motion;
  evaluate();
}

template class ImplicitSolver<float>;
template class ImplicitSolver<double>;

}  // namespace weft::fast
