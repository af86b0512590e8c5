#include <weft/fast_solver/implicit_solver.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Cholesky>

#include <weft/custom_forces/core/error.hpp>
#include <weft/custom_forces/core/trace.hpp>
#include <weft/fast_solver/minimum_degree.hpp>

namespace weft::fast {
namespace {

/// Share of the block correction that a smoothing takes: below 1, so that neighbours that move
/// together do not overshoot; .5 to .7 converge alike.
constexpr float kSmoothing = 0.6F;
/// Of a step that is taken at least.
constexpr double kSmallestShare = 0.1;
/// Squared motion of a step over that without springs from which on its energy is looked at.
constexpr double kMostMotion = 1.2;
/// Rounds, then halvings of the step, until a step that gains energy does not any more.
constexpr int kExtraRounds = 6;
constexpr int kHalvings = 6;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// The matrix of a network whose springs resist as much across as along, over the free nodes.
SymmetricMatrix isotropic_matrix(const SpringNetwork& network, const VectorX<double>& masses,
                                 const std::vector<int>& unknown_of, int num_unknowns,
                                 double inertia_step) {
  std::vector<MatrixPart> parts;
  parts.reserve(at(static_cast<int>(3 * network.edges.cols() + masses.size())));
  for (int i = 0; i < static_cast<int>(masses.size()); ++i) {
    const int u = unknown_of[at(i)];
    if (u >= 0) parts.push_back({u, u, masses[i] / (inertia_step * inertia_step)});
  }
  for (Eigen::Index e = 0; e < network.edges.cols(); ++e) {
    const double weight =
        network.stiffness[e] + network.damping[e] / inertia_step + network.stabiliser[e];
    const int a = unknown_of[at(network.edges(0, e))];
    const int b = unknown_of[at(network.edges(1, e))];
    if (a >= 0) parts.push_back({a, a, weight});
    if (b >= 0) parts.push_back({b, b, weight});
    if (a >= 0 && b >= 0) parts.push_back({a, b, -weight});
  }
  return sum_of_parts(num_unknowns, parts);
}

SparseCholesky factor_of(const SpringNetwork& network, const VectorX<double>& masses,
                         const std::vector<bool>& is_free, double inertia_step) {
  const auto n = static_cast<std::size_t>(masses.size());
  if (is_free.size() != n) {
    throw InvalidArgument("implicit solver: " + std::to_string(is_free.size()) +
                          " flags of free nodes, expected one for each of the " +
                          std::to_string(n) + " nodes");
  }
  std::vector<int> unknown_of(n, -1);
  std::vector<int> names;
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_free[i]) continue;
    unknown_of[i] = static_cast<int>(names.size());
    names.push_back(static_cast<int>(i));
  }
  const SymmetricMatrix matrix =
      isotropic_matrix(network, masses, unknown_of, static_cast<int>(names.size()), inertia_step);
  return {matrix, minimum_degree_order(matrix), names};
}

float dot(const Matrix3X<float>& a, const Matrix3X<float>& b) {
  return a.cwiseProduct(b).sum();
}

}  // namespace

template <class Scalar>
ImplicitSolver<Scalar>::ImplicitSolver(const SpringNetwork& network, const VectorX<double>& masses,
                                       const std::vector<bool>& is_free, double inertia_step)
    : forces_(network, static_cast<int>(masses.size())),
      factor_(factor_of(network, masses, is_free, inertia_step)),
      masses_(masses.cast<Scalar>()),
      is_free_(is_free) {
  const Eigen::Index n = masses.size();
  for (int i = 0; i < static_cast<int>(n); ++i) {
    if (!is_free_[at(i)]) pinned_.push_back(i);
  }
  inertia_.setZero(n);
  holding_forces_.setZero(3, n);
  unbalanced_.setZero(3, n);
  unmoved_.setZero(3, n);
  holds_.assign(at(static_cast<int>(n)), Hold::kFree);
  contact_of_.assign(at(static_cast<int>(n)), -1);
  blocks_.setZero(6, n);
  for (Floats* vectors :
       {&normals_, &friction_, &step_, &residual_vector_, &direction_, &direction_product_,
        &correction_, &correction_product_, &work_, &coarse_, &product_}) {
    vectors->setZero(3, n);
  }
  held_.reserve(at(static_cast<int>(n)));
}

template <class Scalar>
void ImplicitSolver<Scalar>::evaluate(const StepProblem<Scalar>& problem,
                                      ConstMatrix3XRef<Scalar> places) {
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    unbalanced_.col(i) = Scalar(inertia_[i]) * (problem.targets.col(i) - places.col(i));
  }
  forces_.add_forces(places, problem.starts, unbalanced_);
  for (const int node : pinned_) unbalanced_.col(node).setZero();
}

// What holds a node is decided by what it would do if it stuck: the force that is left there is
// weighed against what friction can bear.
template <class Scalar>
void ImplicitSolver<Scalar>::decide_holds(const StepProblem<Scalar>& problem,
                                          ConstMatrix3XRef<Scalar> places, bool is_first) {
  held_before_.assign(holds_.begin(), holds_.end());
  std::fill(holds_.begin(), holds_.end(), Hold::kFree);
  std::fill(contact_of_.begin(), contact_of_.end(), -1);
  held_.clear();
  ties_.clear();
  for (const LedNode<Scalar>& led : problem.led) {
    holds_[at(led.node)] = led.mass > 0 ? Hold::kTied : Hold::kFixed;
  }
  const auto gap_at = [&](const PlaneContact<Scalar>& contact, const auto& place) {
    return contact.normal.dot(place) - contact.offset;
  };
  for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
    const PlaneContact<Scalar>& contact = problem.contacts[c];
    if (!is_free_[at(contact.node)] || holds_[at(contact.node)] != Hold::kFree) continue;
    int& best = contact_of_[at(contact.node)];
    if (best < 0 || gap_at(contact, places.col(contact.node)) <
                        gap_at(problem.contacts[at(best)], places.col(contact.node))) {
      best = static_cast<int>(c);
    }
  }
  for (const PlaneContact<Scalar>& candidate : problem.contacts) {
    const int i = candidate.node;
    if (contact_of_[at(i)] < 0 || &problem.contacts[at(contact_of_[at(i)])] != &candidate) continue;
    const Vector3<Scalar> normal = candidate.normal;
    const Scalar gap = gap_at(candidate, places.col(i));
    const Scalar inertia = Scalar(inertia_[i]);
    const bool was_held = !is_first && held_before_[at(i)] != Hold::kFree;
    const Scalar tie = candidate.mass / (problem.inertia_step * problem.inertia_step);
    Scalar pressure = -normal.dot(unbalanced_.col(i)) + inertia * std::max(Scalar(0), -gap);
    if (candidate.mass > 0 && was_held) pressure = -tie * gap;
    const bool is_near =
        is_first ? std::min(gap, gap_at(candidate, problem.targets.col(i))) < 0 : gap < 0;
    if (!(was_held ? pressure > 0 : is_near)) {
      contact_of_[at(i)] = -1;
      continue;
    }
    const Vector3<Scalar> slip = places.col(i) - problem.starts.col(i) - candidate.motion;
    Vector3<Scalar> tendency = unbalanced_.col(i) + inertia * slip;
    tendency -= normal.dot(tendency) * normal;
    const Scalar most = candidate.friction * std::max(Scalar(0), pressure);
    const Scalar size = tendency.norm();
    const bool sticks = size <= most;
    holds_[at(i)] = candidate.mass > 0 ? Hold::kTied : sticks ? Hold::kFixed : Hold::kOnPlane;
    normals_.col(i) = normal.template cast<float>();
    friction_.col(i).setZero();
    if (!sticks) friction_.col(i) = (-(most / size) * tendency).template cast<float>();
    if (candidate.mass > 0) {
      Vector3<Scalar> place = places.col(i);
      if (sticks) place -= slip;
      place -= gap_at(candidate, place) * normal;
      ties_.push_back({i, tie, sticks ? Vector3<Scalar>(Vector3<Scalar>::Zero()) : normal, place});
    }
    held_.push_back(i);
  }
  for (const LedNode<Scalar>& led : problem.led) {
    held_.push_back(led.node);
    friction_.col(led.node).setZero();
    normals_.col(led.node).setZero();
    if (led.mass <= 0) continue;
    ties_.push_back({led.node, led.mass / (problem.inertia_step * problem.inertia_step),
                     Vector3<Scalar>::Zero(), led.place});
  }
}

// Inverses of symmetric 3 x 3 matrices by their adjugates.
template <class Scalar>
void ImplicitSolver<Scalar>::invert_blocks() {
  forces_.diagonal_blocks(blocks_);
  for (const Tie& tie : ties_) {
    const auto k = static_cast<float>(tie.stiffness);
    const Vector3<float> n = tie.normal.template cast<float>();
    const bool is_full = tie.normal.isZero(0);
    for (int c = 0; c < 3; ++c) {
      blocks_(c, tie.node) += is_full ? k : k * n[c] * n[c];
      if (!is_full) blocks_(3 + c, tie.node) += k * n[c] * n[(c + 1) % 3];
    }
  }
  for (Eigen::Index i = 0; i < blocks_.cols(); ++i) {
    const float a = blocks_(0, i) + inertia_[i];
    const float b = blocks_(1, i) + inertia_[i];
    const float c = blocks_(2, i) + inertia_[i];
    const float d = blocks_(3, i);
    const float e = blocks_(4, i);
    const float f = blocks_(5, i);
    const float xx = b * c - e * e;
    const float xy = e * f - c * d;
    const float xz = d * e - b * f;
    const float determinant = a * xx + d * xy + f * xz;
    const float scale = determinant > 0 ? kSmoothing / determinant : 0.0F;
    blocks_(0, i) = scale * xx;
    blocks_(1, i) = scale * (a * c - f * f);
    blocks_(2, i) = scale * (a * b - d * d);
    blocks_(3, i) = scale * xy;
    blocks_(4, i) = scale * (d * f - a * e);
    blocks_(5, i) = scale * xz;
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::project(Floats& vectors) const {
  for (const int i : pinned_) vectors.col(i).setZero();
  for (const int i : held_) {
    if (holds_[at(i)] == Hold::kFixed) {
      vectors.col(i).setZero();
    } else if (holds_[at(i)] == Hold::kOnPlane) {
      vectors.col(i) -= normals_.col(i).dot(vectors.col(i)) * normals_.col(i);
    }
  }
}

// The global matrix knows nothing of ties, and would move what is tied far too much.
template <class Scalar>
void ImplicitSolver<Scalar>::leave_out_ties(Floats& vectors) const {
  for (const Tie& tie : ties_) {
    if (tie.normal.isZero(0)) {
      vectors.col(tie.node).setZero();
    } else {
      const Vector3<float> normal = tie.normal.template cast<float>();
      vectors.col(tie.node) -= normal.dot(vectors.col(tie.node)) * normal;
    }
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::smooth(const Floats& residual, Floats& correction) const {
  const float* const r = residual.data();
  float* const z = correction.data();
  const float* const b = blocks_.data();
  for (Eigen::Index i = 0; i < residual.cols(); ++i) {
    const float x = r[3 * i];
    const float y = r[3 * i + 1];
    const float w = r[3 * i + 2];
    const float* const m = b + 6 * i;
    z[3 * i] = m[0] * x + m[3] * y + m[5] * w;
    z[3 * i + 1] = m[3] * x + m[1] * y + m[4] * w;
    z[3 * i + 2] = m[5] * x + m[4] * y + m[2] * w;
  }
  project(correction);
}

template <class Scalar>
void ImplicitSolver<Scalar>::add_tie_product(const Floats& displacements, Floats& product) const {
  for (const Tie& tie : ties_) {
    const auto stiffness = static_cast<float>(tie.stiffness);
    const Vector3<float> d = displacements.col(tie.node);
    if (tie.normal.isZero(0)) {
      product.col(tie.node) += stiffness * d;
    } else {
      const Vector3<float> normal = tie.normal.template cast<float>();
      product.col(tie.node) += stiffness * normal.dot(d) * normal;
    }
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::multiply(const Floats& displacements, Floats& product) {
  product = displacements * inertia_.asDiagonal();
  forces_.add_product(displacements, product);
  add_tie_product(displacements, product);
  project(product);
}

// correction = P residual, and its product with the stiffness.
template <class Scalar>
void ImplicitSolver<Scalar>::precondition() {
  smooth(residual_vector_, correction_);
  multiply(correction_, correction_product_);
  work_ = residual_vector_ - correction_product_;
  coarse_.setZero();
  leave_out_ties(work_);
  factor_.solve(work_, coarse_);
  leave_out_ties(coarse_);
  project(coarse_);
  multiply(coarse_, product_);
  correction_ += coarse_;
  correction_product_ += product_;
  work_ = residual_vector_ - correction_product_;
  smooth(work_, coarse_);
  multiply(coarse_, product_);
  correction_ += coarse_;
  correction_product_ += product_;
}

template <class Scalar>
void ImplicitSolver<Scalar>::solve_linear(const StepProblem<Scalar>& problem,
                                          ConstMatrix3XRef<Scalar> places, int iterations) {
  invert_blocks();
  step_.setZero();
  residual_vector_ = unbalanced_.template cast<float>();
  bool moves_held = false;
  for (const int i : held_) {
    if (holds_[at(i)] == Hold::kTied) residual_vector_.col(i) += friction_.col(i);
    if (contact_of_[at(i)] < 0 || holds_[at(i)] == Hold::kTied) continue;
    const PlaneContact<Scalar>& contact = problem.contacts[at(contact_of_[at(i)])];
    Vector3<Scalar> move = Vector3<Scalar>::Zero();
    if (holds_[at(i)] == Hold::kFixed) {
      move = problem.starts.col(i) + contact.motion - places.col(i);
    }
    const Scalar height = contact.normal.dot(places.col(i) + move) - contact.offset;
    step_.col(i) = (move - height * contact.normal).template cast<float>();
    if (holds_[at(i)] == Hold::kOnPlane) residual_vector_.col(i) += friction_.col(i);
    moves_held = true;
  }
  if (moves_held) {
    work_ = step_ * inertia_.asDiagonal();
    forces_.add_product(step_, work_);
    residual_vector_ -= work_;
  }
  for (const Tie& tie : ties_) {
    residual_vector_.col(tie.node) += tie_force(tie, places).template cast<float>();
  }
  project(residual_vector_);
  float previous = 0;
  for (int k = 0; k < iterations; ++k) {
    precondition();
    const float size = dot(residual_vector_, correction_);
    if (!(size > 0)) break;
    if (k == 0) {
      direction_ = correction_;
      direction_product_ = correction_product_;
    } else {
      direction_ = correction_ + (size / previous) * direction_;
      direction_product_ = correction_product_ + (size / previous) * direction_product_;
    }
    previous = size;
    const float curvature = dot(direction_, direction_product_);
    if (!(curvature > 0)) break;
    const float length = size / curvature;
    step_ += length * direction_;
    residual_vector_ -= length * direction_product_;
  }
}

// Planes that no round has met, and those of a node on several. True if anything had to move.
template <class Scalar>
bool ImplicitSolver<Scalar>::clamp(const StepProblem<Scalar>& problem, Matrix3XRef<Scalar> places) {
  bool any = false;
  for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
    const PlaneContact<Scalar>& contact = problem.contacts[c];
    const int i = contact.node;
    if (!is_free_[at(i)] || contact.mass > 0 || holds_[at(i)] == Hold::kTied) continue;
    const Scalar gap = contact.normal.dot(places.col(i)) - contact.offset;
    if (!(gap < 0)) continue;
    places.col(i) -= gap * contact.normal;
    any = true;
    if (holds_[at(i)] != Hold::kFree) continue;
    holds_[at(i)] = Hold::kOnPlane;
    contact_of_[at(i)] = static_cast<int>(c);
    normals_.col(i) = contact.normal.template cast<float>();
    friction_.col(i).setZero();
    held_.push_back(i);
  }
  return any;
}

template <class Scalar>
Vector3<Scalar> ImplicitSolver<Scalar>::tie_force(const Tie& tie,
                                                  ConstMatrix3XRef<Scalar> places) const {
  const Vector3<Scalar> away = places.col(tie.node) - tie.place;
  if (tie.normal.isZero(0)) return -tie.stiffness * away;
  return -tie.stiffness * tie.normal.dot(away) * tie.normal;
}

template <class Scalar>
void ImplicitSolver<Scalar>::find_holding_forces(ConstMatrix3XRef<Scalar> places) {
  holding_forces_.setZero();
  for (const int i : held_) {
    if (holds_[at(i)] == Hold::kFixed) {
      holding_forces_.col(i) = -unbalanced_.col(i);
    } else if (holds_[at(i)] == Hold::kOnPlane) {
      const Vector3<Scalar> normal = normals_.col(i).template cast<Scalar>();
      holding_forces_.col(i) =
          -normal.dot(unbalanced_.col(i)) * normal + friction_.col(i).template cast<Scalar>();
    }
  }
  for (const Tie& tie : ties_) {
    holding_forces_.col(tie.node) =
        tie_force(tie, places) + friction_.col(tie.node).template cast<Scalar>();
  }
}

// A linearisation may promise too much where springs turn far in one step. The work of the forces
// that are left tells: if it opposes the step by more than half of what drove it, back to where a
// straight line between the two is zero.
template <class Scalar>
void ImplicitSolver<Scalar>::hold_back(const StepProblem<Scalar>& problem, double work_before,
                                       Matrix3XRef<Scalar> places) {
  double work_after = 0;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    if (holds_[at(static_cast<int>(i))] != Hold::kFree) continue;
    work_after += static_cast<double>(unbalanced_.col(i).dot(step_.col(i).template cast<Scalar>()));
  }
  if (!(work_before > 0 && work_after < -0.5 * work_before)) return;
  const double share = std::max(kSmallestShare, work_before / (work_before - work_after));
  const auto excess = static_cast<Scalar>(1.0 - share);
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    if (holds_[at(static_cast<int>(i))] != Hold::kFree) continue;
    places.col(i) -= excess * step_.col(i).template cast<Scalar>();
  }
  evaluate(problem, places);
}

template <class Scalar>
void ImplicitSolver<Scalar>::do_round(const StepProblem<Scalar>& problem, int iterations,
                                      bool is_first, Matrix3XRef<Scalar> places) {
  decide_holds(problem, places, is_first);
  solve_linear(problem, places, iterations);
  double work = 0;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    if (holds_[at(static_cast<int>(i))] != Hold::kFree) continue;
    work += static_cast<double>(unbalanced_.col(i).dot(step_.col(i).template cast<Scalar>()));
  }
  places += step_.template cast<Scalar>();
  evaluate(problem, places);
  hold_back(problem, work, places);
  if (clamp(problem, places)) evaluate(problem, places);
}

/// What an implicit step minimises [J], with bodies that are tied to it and with what friction does.
template <class Scalar>
double ImplicitSolver<Scalar>::energy(const StepProblem<Scalar>& problem,
                                      ConstMatrix3XRef<Scalar> places) const {
  double sum = forces_.potential(places, problem.starts);
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    sum += 0.5 * static_cast<double>(inertia_[i]) *
           static_cast<double>((places.col(i) - problem.targets.col(i)).squaredNorm());
  }
  for (const Tie& tie : ties_) {
    Vector3<Scalar> away = places.col(tie.node) - tie.place;
    if (!tie.normal.isZero(0)) away = tie.normal.dot(away) * tie.normal;
    sum += 0.5 * static_cast<double>(tie.stiffness * away.squaredNorm());
  }
  for (const int i : held_) {
    if (contact_of_[at(i)] < 0) continue;
    // A surface that moves may do work by friction; slip only takes it away.
    const Vector3<Scalar>& motion = problem.contacts[at(contact_of_[at(i)])].motion;
    const Vector3<Scalar> friction = friction_.col(i).template cast<Scalar>();
    const Vector3<Scalar> slip = places.col(i) - problem.starts.col(i) - motion;
    sum -= static_cast<double>(friction.dot(motion) + std::min(Scalar(0), friction.dot(slip)));
  }
  return sum;
}

// A contact may have stretched springs; without one, more motion than without springs: they may have
// pulled, or the solution may be off.
template <class Scalar>
bool ImplicitSolver<Scalar>::is_suspicious(const StepProblem<Scalar>& problem,
                                           ConstMatrix3XRef<Scalar> places) const {
  if (!held_.empty()) return true;
  double moved = 0;
  double expected = 0;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const auto mass = static_cast<double>(masses_[i]);
    moved += mass * static_cast<double>((places.col(i) - problem.starts.col(i)).squaredNorm());
    expected +=
        mass * static_cast<double>((problem.targets.col(i) - problem.starts.col(i)).squaredNorm());
  }
  return !(moved <= kMostMotion * expected);
}

// Where nothing has moved but what is led, in front of all planes.
template <class Scalar>
void ImplicitSolver<Scalar>::stay_at_start(const StepProblem<Scalar>& problem) {
  unmoved_ = problem.starts;
  for (const int node : pinned_) unmoved_.col(node) = problem.targets.col(node);
  for (const LedNode<Scalar>& led : problem.led) {
    if (led.mass <= 0) unmoved_.col(led.node) = led.place;
  }
  for (const PlaneContact<Scalar>& contact : problem.contacts) {
    if (!is_free_[at(contact.node)] || contact.mass > 0) continue;
    if (holds_[at(contact.node)] == Hold::kFixed) {
      unmoved_.col(contact.node) = problem.starts.col(contact.node) + contact.motion;
    }
    const Scalar gap = contact.normal.dot(unmoved_.col(contact.node)) - contact.offset;
    if (gap < 0) unmoved_.col(contact.node) -= gap * contact.normal;
  }
}

// The exact solution has no more of the energy that it minimises than the places at the start. One
// that has is iterated on, and at last drawn back: so an implicit step gains no energy, however badly
// it has converged.
template <class Scalar>
void ImplicitSolver<Scalar>::tame(const StepProblem<Scalar>& problem, int iterations,
                                  Matrix3XRef<Scalar> places) {
  stay_at_start(problem);
  const double most = energy(problem, unmoved_);
  for (int attempt = 0; !(energy(problem, places) <= most); ++attempt) {
    if (attempt < kExtraRounds) {
      do_round(problem, iterations, false, places);
      continue;
    }
    if (attempt == kExtraRounds + kHalvings) break;
    for (Eigen::Index i = 0; i < places.cols(); ++i) {
      const bool is_finite = places.col(i).allFinite();
      places.col(i) = is_finite ? Vector3<Scalar>(Scalar(0.5) * (places.col(i) + unmoved_.col(i)))
                                : Vector3<Scalar>(unmoved_.col(i));
    }
    evaluate(problem, places);
  }
}

// What conjugate gradients have left over would push the body as a whole. Where nothing immovable
// holds it, a shift of all nodes, which no spring feels, takes that away to rounding.
template <class Scalar>
void ImplicitSolver<Scalar>::balance(Matrix3XRef<Scalar> places) {
  if (!pinned_.empty()) return;
  Matrix3<double> stiffness =
      Matrix3<double>::Identity() * static_cast<double>(inertia_.template cast<double>().sum());
  for (const int i : held_) {
    if (holds_[at(i)] != Hold::kTied) return;
  }
  const Vector3<double> left =
      (unbalanced_ + holding_forces_).template cast<double>().rowwise().sum();
  for (const Tie& tie : ties_) {
    const Vector3<double> normal = tie.normal.template cast<double>();
    Matrix3<double> directions = Matrix3<double>::Identity();
    if (!tie.normal.isZero(0)) directions = normal * normal.transpose();
    stiffness += static_cast<double>(tie.stiffness) * directions;
  }
  const Vector3<Scalar> shift = stiffness.llt().solve(left).template cast<Scalar>();
  places.colwise() += shift;
  find_holding_forces(places);
}

template <class Scalar>
void ImplicitSolver<Scalar>::solve(const StepProblem<Scalar>& problem, const SolverEffort& effort,
                                   Matrix3XRef<Scalar> places) {
  const TraceScope trace("implicit solve");
  inertia_ = (masses_ / (problem.inertia_step * problem.inertia_step)).template cast<float>();
  for (const int node : pinned_) {
    inertia_[node] = 0;
    places.col(node) = problem.targets.col(node);
  }
  for (const LedNode<Scalar>& led : problem.led) {
    if (led.mass <= 0) places.col(led.node) = led.place;
  }
  forces_.begin_step(problem.starts, problem.time_step);
  evaluate(problem, places);
  const double first = static_cast<double>(unbalanced_.norm());
  for (int round = 0; round < effort.rounds; ++round) {
    do_round(problem, effort.iterations, round == 0, places);
  }
  if (is_suspicious(problem, places)) tame(problem, effort.iterations, places);
  find_holding_forces(places);
  double left = 0;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    left += static_cast<double>((unbalanced_.col(i) + holding_forces_.col(i)).squaredNorm());
  }
  residual_ = first > 0 ? std::sqrt(left) / first : 0.0;
  balance(places);
}

template class ImplicitSolver<float>;
template class ImplicitSolver<double>;

}  // namespace weft::fast
