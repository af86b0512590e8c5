#include <weft/fast_solver/implicit_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <weft/custom_forces/core/error.hpp>
#include <weft/custom_forces/core/trace.hpp>

namespace weft::fast {
namespace {

/// Share of the block correction that a smoothing takes: below 1, so that neighbours that move
/// together do not overshoot; .5 to .7 converge alike.
constexpr float kSmoothing = 0.6F;

/// What is wrong with a solution moves the rigid bodies that give way to it: rounds on top, and the share of the first
/// unbalanced forces that may be left.
constexpr int kLinkedRounds = 1;
constexpr double kLinkedResidual = 0.02;

/// An iteration that gains no more than this share of what the first of its round gained is the last of that round:
/// with short steps inertia outweighs springs, and two are as good as four.
constexpr float kLastGain = 1e-4F;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

std::vector<int> free_nodes(const std::vector<bool>& is_free) {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (is_free[i]) nodes.push_back(static_cast<int>(i));
  }
  return nodes;
}

/// Where nothing touches the cloth, the first round only has to find where springs will point: some of its
/// iterations are worth more in the last.
template <class Scalar>
int iterations_of(const StepProblem<Scalar>& problem, const SolverEffort& effort, int round) {
  const bool is_touched = !problem.contacts.empty() || !problem.led.empty();
  if (is_touched || effort.rounds == 1) return effort.iterations;
  if (round == 0) return 1;
  return effort.iterations + (round == effort.rounds - 1 ? effort.iterations / 4 : 0);
}

GlobalCorrection correction_of(const SpringNetwork& network, const VectorX<double>& masses,
                               const std::vector<bool>& is_free, double inertia_step) {
  const auto n = static_cast<std::size_t>(masses.size());
  if (is_free.size() != n) {
    throw InvalidArgument("implicit solver: " + std::to_string(is_free.size()) +
                          " flags of free nodes, expected one for each of the " +
                          std::to_string(n) + " nodes");
  }
  const std::vector<int> names = free_nodes(is_free);
  const SpringNetwork none;
  const std::vector<char> nowhere;
  return {isotropic_matrix({&network, &nowhere, &none}, masses, names, inertia_step), names,
          static_cast<int>(n)};
}

}  // namespace

template <class Scalar>
ImplicitSolver<Scalar>::ImplicitSolver(const SpringNetwork& network, const VectorX<double>& masses,
                                       const std::vector<bool>& is_free, double inertia_step)
    : forces_(network, static_cast<int>(masses.size())),
      global_(correction_of(network, masses, is_free, inertia_step)),
      inertia_step_(inertia_step) {
  set_nodes(masses, is_free);
}

template <class Scalar>
void ImplicitSolver<Scalar>::set_nodes(const VectorX<double>& masses,
                                       const std::vector<bool>& is_free) {
  is_free_ = is_free;
  const Eigen::Index n = masses.size();
  pinned_.clear();
  for (int i = 0; i < static_cast<int>(n); ++i) {
    if (!is_free_[at(i)]) pinned_.push_back(i);
  }
  held_.clear();
  held_.reserve(at(static_cast<int>(n)));
  holds_.assign(at(static_cast<int>(n)), Hold::kFree);
  contact_of_.assign(at(static_cast<int>(n)), -1);
  for (auto* vectors : {&normals_, &friction_}) vectors->setZero(3, n);
  const Eigen::Index n_filled = fill_up(static_cast<int>(n));
  for (Nodes* vectors :
       {&targets_, &starts_, &places_, &unbalanced_, &holding_forces_, &unmoved_, &remainders_}) {
    vectors->setZero(n_filled, 3);
  }
  masses_.setZero(n_filled);
  masses_.head(n) = masses.cast<Scalar>();
  inertia_.setZero(n_filled);
  if (blocks_.rows() == n_filled) return;  // the others keep no number from one step to the next
  blocks_.setZero(n_filled, 6);
  for (Floats* vectors : {&step_, &residual_vector_, &direction_, &direction_product_, &correction_,
                          &correction_product_, &work_, &coarse_, &coarse_product_}) {
    vectors->setZero(n_filled, 3);
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::tear(const SpringNetwork& springs, const std::vector<char>& is_changed,
                                  const VectorX<double>& masses, const std::vector<int>& origins) {
  std::vector<bool> is_free = is_free_;
  for (const int origin : origins) is_free.push_back(is_free_[at(origin)]);
  forces_.replace(springs, is_changed, static_cast<int>(masses.size()));
  set_nodes(masses, is_free);
  global_.add_copies(origins);
  copies_.insert(copies_.end(), origins.begin(), origins.end());
  is_outdated_ = true;
}

template <class Scalar>
void ImplicitSolver<Scalar>::renew(const ChangedNetwork& network, const VectorX<double>& masses) {
  if (next_global_) {
    if (!next_global_->advance()) return;
    global_ = next_global_->take();
    global_.add_copies(copies_);
    next_global_.reset();
  } else if (is_outdated_) {
    const std::vector<int> names = free_nodes(is_free_);
    next_global_ = std::make_unique<CorrectionMaker>(
        isotropic_matrix(network, masses, names, inertia_step_), names, num_nodes());
    copies_.clear();
    is_outdated_ = false;
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::load(const StepProblem<Scalar>& problem,
                                  ConstMatrix3XRef<Scalar> guess) {
  to_arrays<Scalar>(problem.targets, targets_);
  to_arrays<Scalar>(problem.starts, starts_);
  to_arrays<Scalar>(guess, places_);
  inertia_ = (masses_ / (problem.inertia_step * problem.inertia_step)).template cast<float>();
  for (const int node : pinned_) {
    inertia_[node] = 0;
    places_.row(node) = targets_.row(node);
  }
  weights_ = inertia_.template cast<Scalar>();
  for (const LedNode<Scalar>& led : problem.led) {
    places_.row(led.node) = led.place.transpose();
  }
  load_bodies(problem);
  for (const LedNode<Scalar>& led : problem.led) {
    if (led.body >= 0) places_.row(led.node) = place_of(led).transpose();
  }
  forces_.begin_step(starts_, problem.time_step);
}

template <class Scalar>
void ImplicitSolver<Scalar>::evaluate() {
  for (int axis = 0; axis < 3; ++axis) {
    unbalanced_.col(axis) = weights_.cwiseProduct(targets_.col(axis) - places_.col(axis));
  }
  forces_.add_forces(places_, unbalanced_);
  for (const int node : pinned_) unbalanced_.row(node).setZero();
}

template <class Scalar>
void ImplicitSolver<Scalar>::invert_blocks() {
  blocks_ = forces_.diagonal_blocks();
  vector_kernel().invert_blocks(inertia_.data(), kSmoothing, static_cast<int>(blocks_.rows()),
                                blocks_.data());
}

template <class Scalar>
void ImplicitSolver<Scalar>::smooth(const Floats& residual, Floats& correction) const {
  const auto n = static_cast<int>(residual.rows());
  vector_kernel().multiply_blocks(blocks_.data(), n, residual.data(), correction.data());
  project(correction);
}

// correction + coarse = P residual, each with its product with the stiffness.
template <class Scalar>
void ImplicitSolver<Scalar>::precondition() {
  smooth(residual_vector_, correction_);
  for (Body& body : bodies_) body.correction = body.stiffness.solve(body.residual);
  add_motions(&Body::correction, correction_);
  multiply(correction_, &Body::correction, correction_product_, &Body::correction_product);
  vector_kernel().subtract(residual_vector_.data(), correction_product_.data(), work_.size(),
                           work_.data());
  global_.solve(work_, coarse_);
  project(coarse_);
  multiply(coarse_, &Body::none, coarse_product_, &Body::coarse_product);
}

// The right-hand side, and in step_ what holds demand of nodes before anything is solved for.
template <class Scalar>
void ImplicitSolver<Scalar>::start_linear(const StepProblem<Scalar>& problem) {
  step_.setZero();
  residual_vector_ = unbalanced_.template cast<float>();
  bool moves_held = false;
  for (const int i : held_) {
    if (contact_of_[at(i)] < 0) continue;
    const PlaneContact<Scalar>& contact = problem.contacts[at(contact_of_[at(i)])];
    const Vector3<Scalar> with_body = motion_with(contact.body, contact.arm);
    Vector3<Scalar> move = Vector3<Scalar>::Zero();
    if (holds_[at(i)] == Hold::kFixed) {
      move = at_node(starts_, i) + contact.motion + with_body - at_node(places_, i);
    }
    const Scalar height =
        contact.normal.dot(at_node(places_, i) + move - with_body) - contact.offset;
    step_.row(i) = (move - height * contact.normal).template cast<float>().transpose();
    if (holds_[at(i)] == Hold::kOnPlane) residual_vector_.row(i) += friction_.col(i).transpose();
    moves_held = true;
  }
  for (const LedNode<Scalar>& led : problem.led) {
    if (led.body < 0) continue;
    step_.row(led.node) =
        (place_of(led) - at_node(places_, led.node)).template cast<float>().transpose();
    moves_held = true;
  }
  find_unbalanced(&Body::residual);
  if (moves_held) {
    forces_.multiply(inertia_, step_, work_);
    residual_vector_ -= work_;
    for (Body& body : bodies_) body.coarse_product.setZero();
    gather(work_, &Body::coarse_product);
    for (Body& body : bodies_) body.residual -= body.coarse_product;
  }
  project(residual_vector_);
}

template <class Scalar>
void ImplicitSolver<Scalar>::solve_linear(const StepProblem<Scalar>& problem, int iterations) {
  invert_blocks();
  start_linear(problem);
  factorise_bodies();
  // Flexible conjugate gradients (Notay 2000): the preconditioner is not symmetric, for a second
  // smoothing costs more than it gains, so that a direction is made conjugate explicitly.
  const VectorKernel& vectors = vector_kernel();
  const long size = residual_vector_.size();
  direction_.setZero();
  direction_product_.setZero();
  for (Body& body : bodies_) {
    for (Floats6* vector : {&body.step, &body.direction, &body.direction_product})
      vector->setZero();
  }
  float curvature = 1;
  float first_gain = 0;
  for (int k = 0; k < iterations; ++k) {
    precondition();
    auto [gain, overlap] = vectors.add_correction(
        coarse_.data(), coarse_product_.data(), residual_vector_.data(), direction_product_.data(),
        size, correction_.data(), correction_product_.data());
    for (Body& body : bodies_) {
      body.correction_product += body.coarse_product;
      gain += body.correction.dot(body.residual);
      overlap += body.correction.dot(body.direction_product);
    }
    if (!(gain > 0)) break;
    const float share = overlap / curvature;
    auto [new_curvature, descent] =
        vectors.turn(correction_.data(), correction_product_.data(), residual_vector_.data(), share,
                     size, direction_.data(), direction_product_.data());
    for (Body& body : bodies_) {
      body.direction = body.correction - share * body.direction;
      body.direction_product = body.correction_product - share * body.direction_product;
      new_curvature += body.direction.dot(body.direction_product);
      descent += body.direction.dot(body.residual);
    }
    if (!(new_curvature > 0)) break;
    curvature = new_curvature;
    const float length = descent / curvature;
    vectors.advance(direction_.data(), direction_product_.data(), length, size, step_.data(),
                    residual_vector_.data());
    for (Body& body : bodies_) {
      body.step += length * body.direction;
      body.residual -= length * body.direction_product;
    }
    if (k == 0) first_gain = gain;
    if (gain <= kLastGain * first_gain) break;
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::do_round(const StepProblem<Scalar>& problem, int iterations,
                                      bool is_first) {
  decide_holds(problem, is_first);
  solve_linear(problem, iterations);
  const double of_others = work_of_bodies() - work_of_held();
  const double work =
      sum_kernel<Scalar>().move(unbalanced_.data(), step_.data(), step_.size(), places_.data());
  move_bodies(1);
  evaluate();
  hold_back(work + of_others);
  if (clamp(problem)) evaluate();
}

template <class Scalar>
double ImplicitSolver<Scalar>::left_over() {
  double sum = sum_kernel<Scalar>().squares(unbalanced_.data(), unbalanced_.size());
  for (const int i : held_) {
    const Vector3<Scalar> force = at_node(unbalanced_, i);
    sum += static_cast<double>((force + at_node(holding_forces_, i)).squaredNorm()) -
           static_cast<double>(force.squaredNorm());
  }
  find_unbalanced(&Body::unbalanced);
  for (const Body& body : bodies_) {
    sum += static_cast<double>(body.unbalanced.template head<3>().squaredNorm());
  }
  return std::sqrt(std::max(0.0, sum));
}

template <class Scalar>
void ImplicitSolver<Scalar>::solve(const StepProblem<Scalar>& problem, const SolverEffort& effort,
                                   Matrix3XRef<Scalar> places) {
  const TraceScope trace("implicit solve");
  const SumKernel<Scalar>& sums = sum_kernel<Scalar>();
  load(problem, places);
  evaluate();
  const double first = std::sqrt(sums.squares(unbalanced_.data(), unbalanced_.size()));
  for (int round = 0; round < effort.rounds; ++round) {
    do_round(problem, iterations_of(problem, effort, round), round == 0);
  }
  for (int extra = 0; !links_.empty() && extra < kLinkedRounds; ++extra) {
    find_holding_forces();
    if (left_over() <= kLinkedResidual * first) break;
    do_round(problem, effort.iterations, false);
  }
  step_energy_ = 0.5 * sums.weighted_distance(weights_.data(), weights_.size(), targets_.data(),
                                              starts_.data());
  if (is_suspicious(problem)) tame(problem, effort.iterations);
  find_holding_forces();
  residual_ = first > 0 ? left_over() / first : 0.0;
  balance();
  find_remainders();
  from_arrays<Scalar>(places_, places);
}

// One step of Jacobi's method for the forces that are left, which places on their grid cannot follow.
template <class Scalar>
void ImplicitSolver<Scalar>::find_remainders() {
  constexpr Scalar kHalfRounding = std::numeric_limits<Scalar>::epsilon() / 2;
  const BlockArrays& blocks = forces_.diagonal_blocks();
  const Eigen::Index n = weights_.size();
  for (int axis = 0; axis < 3; ++axis) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const Scalar stiffness = Scalar(inertia_[i] + blocks(i, axis));
      const Scalar left = unbalanced_(i, axis) + holding_forces_(i, axis);
      const Scalar most = kHalfRounding * std::abs(places_(i, axis));
      const Scalar way = left / (stiffness > 0 ? stiffness : Scalar(1));
      remainders_(i, axis) = way > most ? most : way < -most ? -most : way;
    }
  }
  for (const int i : held_) {
    if (holds_[at(i)] != Hold::kOnPlane) remainders_.row(i).setZero();
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::add_remainders(Matrix3XRef<Scalar> ways) const {
  for (Eigen::Index i = 0; i < ways.cols(); ++i) ways.col(i) += at_node(remainders_, i);
}

template class ImplicitSolver<float>;
template class ImplicitSolver<double>;

}  // namespace weft::fast
