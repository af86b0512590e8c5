#include <weft/fast_solver/implicit_solver.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <weft/core/index.hpp>
#include <weft/core/trace.hpp>
#include <weft/fast_solver/newton/node_stiffness.hpp>

namespace weft::fast {
namespace {

/// Share of the block correction that a smoothing takes: below 1, so that neighbors that move
/// together do not overshoot; .5 to .7 converge alike.
constexpr float kSmoothing = 0.6F;

/// An error of the solution accelerates two-way coupled bodies: additional iterations, and the fraction of the first
/// residual forces that may be left.
constexpr int kLinkedIterations = 1;
constexpr double kLinkedResidual = 0.02;

/// A curvature below this fraction of the correction's own is rounding [-].
constexpr float kLeastCurvature = 1e-4F;

}  // namespace

template <class Scalar>
void ImplicitSolver<Scalar>::load(const StepProblem<Scalar>& problem,
                                  ConstMatrix3XRef<Scalar> guess) {
  forces_.set_time_step(problem.time_step);
  const Scalar squared_step = problem.inertia_step * problem.inertia_step;
  for_each_part([&](NodeRange nodes) {
    to_arrays<Scalar>(problem.inertial_positions, nodes, inertial_positions_);
    to_arrays<Scalar>(problem.start_positions, nodes, start_positions_);
    to_arrays<Scalar>(guess, nodes, positions_);
    for (int i = nodes.begin; i < nodes.end; ++i) {
      inertia_[i] = static_cast<float>(masses_[i] / squared_step);
    }
    for (const int node : in_range(pinned_, nodes)) {
      inertia_[node] = 0;
      positions_.row(node) = inertial_positions_.row(node);
    }
    for (int i = nodes.begin; i < nodes.end; ++i) weights_[i] = static_cast<Scalar>(inertia_[i]);
    const int count = nodes.end - nodes.begin;
    system_inertia_.segment(nodes.begin, count) = inertia_.segment(nodes.begin, count);
  });
  for (const KinematicNode<Scalar>& kinematic : problem.kinematic) {
    positions_.row(kinematic.node) = kinematic.position.transpose();
  }
  load_bodies(problem);
  supports_.load(problem.supports);
  follow_kinematic(problem);
  for (const KinematicNode<Scalar>& kinematic : problem.kinematic) {
    if (kinematic.body >= 0) positions_.row(kinematic.node) = position_of(kinematic).transpose();
  }
  if (!problem.continues) supports_.lift(start_positions_, positions_);
  const auto stride = static_cast<int>(weights_.size());
  step_energy_ =
      0.5 * sum_over_parts([&](NodeRange nodes) {
        forces_.begin_step(nodes, start_positions_);
        return sum_kernel<Scalar>().weighted_distance(
            weights_.data(), stride, nodes, inertial_positions_.data(), start_positions_.data());
      });
}

// Products with the stiffness of step forces need the strains of all elements, which other parts' nodes may have.
template <class Scalar>
void ImplicitSolver<Scalar>::find_strains(const Floats& displacements) {
  if (!step_forces_.has_elements()) return;
  team_->run(parts_.count(), [this, &displacements](int part) {
    step_forces_.find_strains(part, parts_.count(), displacements);
  });
}

// Evaluates the residual at the present positions, and its work along the last step.
template <class Scalar>
void ImplicitSolver<Scalar>::evaluate(bool linearizes) {
  step_forces_.evaluate(positions_, linearizes, forces_);
  const auto stride = static_cast<int>(weights_.size());
  const SumKernel<Scalar>& sums = sum_kernel<Scalar>();
  const auto both = sum_over_parts<Eigen::Array2d>([this, stride, linearizes,
                                                    &sums](NodeRange nodes) {
    const int count = nodes.end - nodes.begin;
    for (int axis = 0; axis < 3; ++axis) {
      residual_forces_.col(axis).segment(nodes.begin, count) =
          weights_.segment(nodes.begin, count)
              .cwiseProduct(inertial_positions_.col(axis).segment(nodes.begin, count) -
                            positions_.col(axis).segment(nodes.begin, count));
    }
    forces_.add_forces(nodes, positions_, residual_forces_, linearizes);
    step_forces_.add(nodes, residual_forces_, linearizes ? &forces_.diagonal_blocks() : nullptr);
    supports_.add_forces(nodes, positions_, start_positions_, bodies_, residual_forces_);
    for (const int node : in_range(pinned_, nodes)) residual_forces_.row(node).setZero();
    return Eigen::Array2d(sums.dot(residual_forces_.data(), step_.data(), stride, nodes),
                          sums.squares(residual_forces_.data(), stride, nodes));
  });
  work_left_ = both[0];
  residual_squares_ = both[1];
}

// The drag of sliding nodes becomes the second derivative of their friction.
template <class Scalar>
void ImplicitSolver<Scalar>::relieve(NodeRange nodes, const Floats& displacements,
                                     Floats& product) const {
  for (const int i : in_range(constrained_, nodes)) {
    if (contact_states_[at(i)] != ContactState::kOnPlane) continue;
    friction_.relieve_product(i, displacements, product);
  }
}

// Rows of linked nodes contain their own tangential motion, if any, and get that of the body.
template <class Scalar>
template <class Next>
void ImplicitSolver<Scalar>::multiply(const Floats& displacements, Floats6 Body::*motion,
                                      Floats& product, Floats6 Body::*body_product,
                                      const Next& and_then) {
  const bool is_linked = !links_.empty() || !supports_.empty();
  const auto finish = [this, &product, and_then](NodeRange nodes, int part) {
    project(nodes, product);
    and_then(nodes, part);
  };
  find_strains(displacements);
  team_->run(parts_.count(), [this, &displacements, &product, is_linked, finish](int part) {
    multiply_nodes(parts_[part], displacements, product);
    relieve(parts_[part], displacements, product);
    if (!is_linked) finish(parts_[part], part);
  });
  for (Body& body : bodies_) body.*body_product = body.inertia * (body.*motion);
  couplings_.add_forces(bodies_, motion, body_product);
  if (!is_linked) return;
  supports_.add_products(displacements, motion, product, bodies_, body_product);
  gather(links_, product, bodies_, body_product);
  add_drags(links_, friction_.drags(), displacements, motion, product, bodies_, body_product);
  team_->run(parts_.count(), [this, finish](int part) { finish(parts_[part], part); });
}

// The preconditioner needs two things of a part's own nodes: the residual smoothed by block Jacobi, the fine level, which is accurate for
// motion that is transverse to the sheet, and its restriction for the coarse correction.
template <class Scalar>
void ImplicitSolver<Scalar>::smooth(int part) {
  vector_kernel().multiply_blocks(blocks_.data(), static_cast<int>(blocks_.rows()), parts_[part],
                                  residual_vector_.data(), smoothed_.data());
  project(parts_[part], smoothed_);
  coarse_correction_.restrict_residual(part, coarse_roles_.held(), residual_vector_);
}

// correction = P residual, with its product with the stiffness. P is additive (Dryja and Widlund 1987): the sum of the
// smoothed residual, of the coarse correction and of the bodies' own, each of them symmetric and positive. A cycle in which
// one follows the other takes fewer iterations where the coarse matrix is exact; where it is a sample, and springs are stiff,
// residual . correction became negative, and iterations ended at once.
template <class Scalar>
typename ImplicitSolver<Scalar>::Overlaps ImplicitSolver<Scalar>::precondition(Floats& correction,
                                                                               bool is_first) {
  coarse_correction_.solve(*team_);
  const auto stride = static_cast<int>(coarse_.rows());
  team_->run(parts_.count(), [this, &correction, stride](int part) {
    coarse_correction_.prolongate(part, coarse_roles_.held(), coarse_);
    project(parts_[part], coarse_);
    vector_kernel().add(smoothed_.data(), coarse_.data(), stride, parts_[part], correction.data());
  });
  correct_bodies(links_, residual_vector_, bodies_);
  add_carried(links_, bodies_, &Body::correction, correction);
  std::array<VectorKernel::Products, WorkerTeam::kMostParts> of_part;
  multiply(
      correction, &Body::correction, correction_product_, &Body::correction_product,
      [this, &correction, is_first, stride, products = of_part.data()](NodeRange nodes, int part) {
        products[part] = vector_kernel().dot_products(
            correction.data(), correction_product_.data(), residual_vector_.data(),
            is_first ? nullptr : direction_product_.data(), stride, nodes);
      });
  Overlaps sum{0, 0, 0};
  for (int part = 0; part < parts_.count(); ++part) {
    sum.by_residual += of_part[at(part)].by_residual;
    sum.by_direction += of_part[at(part)].by_direction;
    sum.by_product += of_part[at(part)].by_product;
  }
  for (Body& body : bodies_) {
    sum.by_residual += body.correction.dot(body.residual);
    sum.by_direction += body.correction.dot(body.direction_product);
    sum.by_product += body.correction.dot(body.correction_product);
  }
  return sum;
}

// Sets up the right-hand side, and in step_ the displacements that constraints prescribe.
template <class Scalar>
void ImplicitSolver<Scalar>::start_linear(const StepProblem<Scalar>& problem) {
  for (const BodyLink& link : links_) {
    if (link.is_dragged)
      system_inertia_[link.node] += static_cast<float>(friction_.drags()[link.node]);
  }
  for_each_part([this](NodeRange nodes) {
    const int count = nodes.end - nodes.begin;
    step_.middleRows(nodes.begin, count).setZero();
    residual_vector_.middleRows(nodes.begin, count) =
        residual_forces_.middleRows(nodes.begin, count).template cast<float>();
    vector_kernel().invert_blocks(system_inertia_.data(), kSmoothing,
                                  static_cast<int>(blocks_.rows()), nodes,
                                  forces_.diagonal_blocks().data(), blocks_.data());
  });
  supports_.invert_blocks(forces_.diagonal_blocks(), system_inertia_, kSmoothing, blocks_);
  for (const int i : constrained_) {
    if (contact_states_[at(i)] != ContactState::kOnPlane) continue;
    friction_.relieve_inverse(i, kSmoothing, blocks_);
  }
  for (const BodyLink& link : links_) {
    if (link.is_dragged) system_inertia_[link.node] = inertia_[link.node];  // add_drags() has it
  }
  bool moves_held = false;
  for (const int i : constrained_) {
    if (contact_of_[at(i)] < 0) continue;
    const PlaneContact<Scalar>& contact = problem.contacts[at(contact_of_[at(i)])];
    const Vector3<Scalar> with_body = motion_with(contact.body, contact.lever_arm);
    Vector3<Scalar> move = Vector3<Scalar>::Zero();
    if (contact_states_[at(i)] == ContactState::kFixed) {
      move = at_node(start_positions_, i) + contact.motion + with_body - at_node(positions_, i);
    }
    const Scalar height =
        contact.normal.dot(at_node(positions_, i) + move - with_body) - contact.offset;
    step_.row(i) = (move - height * contact.normal).template cast<float>().transpose();
    if (contact_states_[at(i)] == ContactState::kOnPlane)
      residual_vector_.row(i) += friction_.force(i).transpose();
    moves_held = true;
  }
  for (const KinematicNode<Scalar>& kinematic : problem.kinematic) {
    if (kinematic.body < 0) continue;
    step_.row(kinematic.node) = (position_of(kinematic) - at_node(positions_, kinematic.node))
                                    .template cast<float>()
                                    .transpose();
    moves_held = true;
  }
  find_body_residuals(&Body::residual);
  for (Body& body : bodies_) body.coarse_product.setZero();
  if (moves_held) {
    find_strains(step_);
    for_each_part([this](NodeRange nodes) { multiply_nodes(nodes, step_, work_); });
    for (Body& body : bodies_) body.correction.setZero();
    supports_.add_products(step_, &Body::correction, work_, bodies_, &Body::coarse_product);
  }
  team_->run(parts_.count(), [this, moves_held](int part) {
    const NodeRange nodes = parts_[part];
    const int count = nodes.end - nodes.begin;
    if (moves_held) {
      residual_vector_.middleRows(nodes.begin, count) -= work_.middleRows(nodes.begin, count);
    }
    project(nodes, residual_vector_);
    smooth(part);
  });
  if (!moves_held || (links_.empty() && supports_.empty())) return;
  gather(links_, work_, bodies_, &Body::coarse_product);
  for (Body& body : bodies_) body.residual -= body.coarse_product;
}

// m / h'^2, and the drag of nodes that slide on what does not give way.
template <class Scalar>
void ImplicitSolver<Scalar>::set_system_inertia() {
  if (has_drag_ || !constrained_.empty()) system_inertia_ = inertia_;
  has_drag_ = !constrained_.empty();
  for (const int i : constrained_) {
    if (contact_states_[at(i)] == ContactState::kOnPlane)
      system_inertia_[i] += static_cast<float>(friction_.drags()[i]);
  }
  for (const BodyLink& link : links_) system_inertia_[link.node] = inertia_[link.node];
}

// Flexible conjugate gradients (Notay 2000). The preconditioned residuals of the last iterations stay in corrections_, and move()
// adds them to the step. Returns twice the decrease of the quadratic model. It is the sum of gain times alpha, the squared
// energy norm of the initial error; its last terms estimate what is left (Strakos and Tichy 2002).
template <class Scalar>
LinearGain ImplicitSolver<Scalar>::solve_linear(const StepProblem<Scalar>& problem,
                                                const NewtonIteration& iteration) {
  factorize_bodies();
  start_linear(problem);
  for (Body& body : bodies_) {
    for (Floats6* vector : {&body.step, &body.direction, &body.direction_product})
      vector->setZero();
  }
  float curvature = 1;
  bool is_broken = false;
  gains_.clear();
  directions_.clear();
  has_direction_ = false;
  for (int k = 0; k < iteration.iterations; ++k) {
    const Overlaps overlaps = precondition(corrections_[at(directions_.count())], k == 0);
    // The residual has nothing of the last direction any more.
    const float gain = overlaps.by_residual;
    if (!(gain > 0)) {
      is_broken = !(gain == 0);
      break;
    }
    float beta = overlaps.by_direction / curvature;
    curvature = overlaps.by_product - beta * overlaps.by_direction;
    if (!(curvature > kLeastCurvature * overlaps.by_product)) {
      // Rounding has left nothing that is conjugate to the last direction: conjugate gradients begin anew.
      beta = 0;
      curvature = overlaps.by_product;
    }
    if (is_broken = !(curvature > 0); is_broken) break;
    const float alpha = gain / curvature;
    directions_.add(beta, alpha);
    for (Body& body : bodies_) {
      body.direction = body.correction - beta * body.direction;
      body.direction_product = body.correction_product - beta * body.direction_product;
      body.step += alpha * body.direction;
      body.residual -= alpha * body.direction_product;
    }
    gains_.add(static_cast<double>(gain) * static_cast<double>(alpha));
    if (k + 1 == iteration.iterations || gains_.are_enough(iteration.accuracy)) break;
    team_->run(parts_.count(),
               [this, beta, alpha, is_first = k == 0, is_full = directions_.is_full()](int part) {
                 const NodeRange nodes = parts_[part];
                 vector_kernel().advance(correction_product_.data(), beta, alpha, is_first,
                                         static_cast<int>(step_.rows()), nodes,
                                         direction_product_.data(), residual_vector_.data());
                 if (is_full) sum_up(nodes, true);
                 smooth(part);
               });
    if (!directions_.is_full()) continue;
    directions_.clear();
    has_direction_ = true;
  }
  LinearGain sum = gains_.sum(iteration.accuracy);
  sum.is_broken = is_broken;
  return sum;
}

// Adds the stored corrections to the step, and replaces them by the last direction if another iteration follows.
template <class Scalar>
void ImplicitSolver<Scalar>::sum_up(NodeRange nodes, bool keeps_direction) {
  const int count = directions_.count();
  std::array<const float*, DirectionWeights::kMost + 1> vectors{};
  for (int k = 0; k < count; ++k) vectors[at(k)] = corrections_[at(k)].data();
  vectors[at(count)] = direction_.data();
  const auto stride = static_cast<int>(step_.rows());
  const DirectionWeights::Weights of_step = directions_.of_step();
  vector_kernel().add_vectors(vectors.data(), of_step.data(), count + (has_direction_ ? 1 : 0), 1,
                              stride, nodes, step_.data());
  if (!keeps_direction) return;
  const DirectionWeights::Weights of_last = directions_.of_last_direction();
  vector_kernel().add_vectors(vectors.data(), of_last.data(), count,
                              has_direction_ ? of_last[at(count)] : 0, stride, nodes,
                              direction_.data());
}

template <class Scalar>
void ImplicitSolver<Scalar>::move() {
  const auto stride = static_cast<int>(step_.rows());
  work_done_ = sum_over_parts([this, stride](NodeRange nodes) {
    sum_up(nodes, false);
    return sum_kernel<Scalar>().move(residual_forces_.data(), step_.data(), stride, nodes,
                                     positions_.data());
  });
  move_bodies(1);
}

template <class Scalar>
double ImplicitSolver<Scalar>::residual_norm() {
  double sum = residual_squares_;
  for (const int i : constrained_) {
    const Vector3<Scalar> force = at_node(residual_forces_, i);
    sum += static_cast<double>((force + at_node(constraint_forces_, i)).squaredNorm()) -
           static_cast<double>(force.squaredNorm());
  }
  find_body_residuals(&Body::present_residual);
  for (const Body& body : bodies_) {
    sum += static_cast<double>(body.present_residual.template head<3>().squaredNorm());
  }
  return std::sqrt(std::max(0.0, sum));
}

template <class Scalar>
void ImplicitSolver<Scalar>::solve(const StepProblem<Scalar>& problem,
                                   const SolverSettings& solver_settings,
                                   Matrix3XRef<Scalar> positions, WorkerTeam& team) {
  const TraceScope trace("implicit solve");
  team_ = &team;
  step_forces_.begin_step(problem.forces, forces_);
  load(problem, positions);
  evaluate();
  const double first = std::sqrt(residual_squares_);
  gains_.reserve(solver_settings.linear_iterations);
  iterate(problem, solver_settings);
  for (int extra = 0; !links_.empty() && extra < kLinkedIterations; ++extra) {
    find_constraint_forces();
    if (residual_norm() <= kLinkedResidual * first) break;
    iterate_once(problem, {.iterations = solver_settings.linear_iterations});
  }
  if (!report_.is_converged || !constrained_.empty())
    enforce_descent(problem, solver_settings.linear_iterations);
  update_friction(problem, false);
  find_constraint_forces();
  residual_ = first > 0 ? residual_norm() / first : 0.0;
  const std::optional<Vector3<Scalar>> shift = net_momentum_correction(problem);
  for_each_part([&](NodeRange nodes) {
    const int end = std::min(nodes.end, num_nodes());
    if (shift) {
      const int count = end - nodes.begin;
      positions_.middleRows(nodes.begin, count).rowwise() += shift->transpose();
      residual_forces_.middleRows(nodes.begin, count) -=
          weights_.segment(nodes.begin, count) * shift->transpose();
    }
    find_compensation<Scalar>(nodes, forces_.diagonal_blocks(), inertia_, residual_forces_,
                              constraint_forces_, positions_, compensation_);
    from_arrays<Scalar>(positions_, nodes, positions);
  });
  for (const int i : constrained_) {
    if (contact_states_[at(i)] != ContactState::kOnPlane) compensation_.row(i).setZero();
  }
  team_ = nullptr;
  step_forces_.begin_step(nullptr, forces_);
}

template <class Scalar>
void ImplicitSolver<Scalar>::add_compensation(int first_node,
                                              Matrix3XRef<Scalar> displacements) const {
  for (Eigen::Index i = 0; i < displacements.cols(); ++i)
    displacements.col(i) += at_node(compensation_, first_node + i);
}

template <class Scalar>
void ImplicitSolver<Scalar>::get_forces(int first_node, Matrix3XRef<Scalar> forces) const {
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    const Eigen::Index node = first_node + i;
    const Vector3<Scalar> without = at_node(inertial_positions_, node) - at_node(positions_, node);
    forces.col(i) = at_node(residual_forces_, node) - weights_[node] * without;
  }
}

template <class Scalar>
double ImplicitSolver<Scalar>::spring_energy(ConstMatrix3XRef<Scalar> positions, WorkerTeam& team) {
  team_ = &team;
  for_each_part([&](NodeRange nodes) { to_arrays<Scalar>(positions, nodes, unmoved_); });
  const double energy =
      sum_over_parts([&](NodeRange nodes) { return forces_.potential(nodes, unmoved_); });
  team_ = nullptr;
  return energy;
}

template <class Scalar>
void ImplicitSolver<Scalar>::find_spring_forces(ConstMatrix3XRef<Scalar> positions,
                                                Matrix3XRef<Scalar> forces, WorkerTeam& team) {
  team_ = &team;
  for_each_part([&](NodeRange nodes) {
    to_arrays<Scalar>(positions, nodes, unmoved_);
    residual_forces_.middleRows(nodes.begin, nodes.end - nodes.begin).setZero();
  });
  for_each_part([&](NodeRange nodes) {
    forces_.add_forces(nodes, unmoved_, residual_forces_, false);
    for (int i = nodes.begin; i < std::min(nodes.end, num_nodes()); ++i) {
      forces.col(i) += at_node(residual_forces_, i);
    }
  });
  team_ = nullptr;
}

#ifndef WEFT_SOLVER_IS_ONE_UNIT
template class ImplicitSolver<float>;
template class ImplicitSolver<double>;
#endif

}  // namespace weft::fast
