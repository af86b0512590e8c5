// Two-way coupled rigid bodies: six unknowns each, which are solved for together with the nodes.
// Tested by tests/fast_solver/implicit_solver_test.cpp.
#include <algorithm>

#include <weft/fast_solver/implicit_solver.hpp>

#include <weft/core/index.hpp>

namespace weft::fast {
template <class Scalar>
void ImplicitSolver<Scalar>::load_bodies(const StepProblem<Scalar>& problem) {
  bodies_.resize(problem.bodies.size());
  const Scalar per_square = 1 / (problem.inertia_step * problem.inertia_step);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const RigidInertia<Scalar>& given = problem.bodies[b];
    Body& body = bodies_[b];
    body.motion = given.guess;
    body.motion_alone << given.motion, given.turn;
    body.inertia.setZero();
    body.inertia.template topLeftCorner<3, 3>().diagonal() =
        (per_square * given.mass).template cast<float>();
    body.inertia.template bottomRightCorner<3, 3>() =
        (per_square * given.inertia).template cast<float>();
    body.inertia += (per_square * given.held).template cast<float>();
    if (body.is_link = !given.of_link.isZero(0); body.is_link) {
      body.inertia += (per_square * given.of_link).template cast<float>();
    }
    body.is_held = !given.held.isZero(0) || given.has_base;
  }
  couplings_.load(problem.couplings, per_square);
  links_.clear();
}

template <class Scalar>
void ImplicitSolver<Scalar>::link(int node, int body, const Vector3<Scalar>& lever_arm,
                                  const Vector3<Scalar>& normal) {
  const bool is_dragged = !normal.isZero(0) && friction_.drags()[node] > 0;
  links_.push_back(
      {node, body, lever_arm.template cast<float>(), normal.template cast<float>(), is_dragged});
}

// The motion in the present state; none for what is no body.
template <class Scalar>
Vector3<Scalar> ImplicitSolver<Scalar>::motion_with(int body,
                                                    const Vector3<Scalar>& lever_arm) const {
  if (body < 0) return Vector3<Scalar>::Zero();
  return motion_at(bodies_[at(body)].motion, lever_arm);
}

// The rotated lever arm. The rotation is exact because a first-order one would stretch what is attached to a spinning body.
template <class Scalar>
Vector3<Scalar> ImplicitSolver<Scalar>::turned(int body, const Vector3<Scalar>& lever_arm) const {
  const Vector3<Scalar> turn = bodies_[at(body)].motion.template tail<3>();
  const Scalar angle = turn.norm();
  if (angle == 0) return lever_arm;
  return Eigen::AngleAxis<Scalar>(angle, turn / angle) * lever_arm;
}

template <class Scalar>
Vector3<Scalar> ImplicitSolver<Scalar>::position_of(const KinematicNode<Scalar>& kinematic) const {
  const Vector3<Scalar> displacement = bodies_[at(kinematic.body)].motion.template head<3>();
  return kinematic.position + displacement + turned(kinematic.body, kinematic.lever_arm) -
         kinematic.lever_arm;
}

// A body without linked nodes in this iteration moves as without the cloth, unless it is coupled to one that has some.
template <class Scalar>
void ImplicitSolver<Scalar>::release_bodies() {
  for (Body& body : bodies_) body.is_linked = false;
  for (const BodyLink& link : links_) bodies_[at(link.body)].is_linked = true;
  for (const NodeSupport<Scalar>& support : supports_.all()) {
    if (support.body >= 0) bodies_[at(support.body)].is_linked = true;
  }
  couplings_.spread_links(bodies_);
  for (Body& body : bodies_) {
    if (!body.is_linked) body.motion.setZero();
  }
}

// Factorizes the 6 x 6 stiffness of each body: its inertia and the springs of all nodes that move with it. It is computed
// column by column, because springs between two such nodes do not contribute.
template <class Scalar>
void ImplicitSolver<Scalar>::factorize_bodies() {
  if (bodies_.empty()) return;
  Floats& correction = corrections_[0];
  correction.setZero();
  for (Body& other : bodies_) other.correction.setZero();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    typename Body::Matrix6 stiffness = body.inertia;
    linked_blocks_.clear();
    for (const BodyLink& link : links_) {
      if (link.body == static_cast<int>(b)) linked_blocks_.push_back(link.node / kNodeBlock);
    }
    std::sort(linked_blocks_.begin(), linked_blocks_.end());
    linked_blocks_.erase(std::unique(linked_blocks_.begin(), linked_blocks_.end()),
                         linked_blocks_.end());
    const bool is_behind = std::any_of(
        supports_.all().begin(), supports_.all().end(),
        [&](const NodeSupport<Scalar>& one) { return one.body == static_cast<int>(b); });
    for (int k = 0; k < 6 && (is_behind || !linked_blocks_.empty()); ++k) {
      body.correction = Floats6::Unit(k);
      add_carried(links_, bodies_, &Body::correction, correction);
      find_strains(correction);
      for (const int block : linked_blocks_) {
        multiply_nodes({block * kNodeBlock, (block + 1) * kNodeBlock}, correction,
                       correction_product_);
      }
      body.correction_product = body.inertia.col(k);
      supports_.add_products(correction, &Body::correction, correction_product_, bodies_,
                             &Body::correction_product);
      gather_carried(links_, static_cast<int>(b), correction_product_, body.correction_product);
      stiffness.col(k) = body.correction_product;
      for (const BodyLink& link : links_) correction.row(link.node).setZero();
    }
    body.correction.setZero();
    body.stiffness.compute((stiffness + stiffness.transpose()) / 2);
    if (body.stiffness.info() != Eigen::Success) {
      body.stiffness.compute(typename Body::Matrix6(stiffness.diagonal().asDiagonal()));
    }
  }
}

// The generalized residual of each body: forces of linked nodes, friction and its own inertia.
template <class Scalar>
void ImplicitSolver<Scalar>::find_body_residuals(Floats6 Body::*result) {
  for (Body& body : bodies_) body.*result = body.inertia * body.motion.template cast<float>();
  couplings_.add_forces(bodies_, &Body::motion, result);
  for (Body& body : bodies_) body.*result = -(body.*result);
  supports_.add_reactions(positions_, start_positions_, bodies_, result);
  for (const BodyLink& link : links_) {
    const Vector3<Scalar> normal = link.normal.template cast<Scalar>();
    Vector3<Scalar> force = at_node(residual_forces_, link.node);
    if (!normal.isZero(0)) {
      force = normal.dot(force) * normal - friction_.force(link.node).template cast<Scalar>();
    }
    const Vector3<float> rounded = force.template cast<float>();
    Floats6& sum = bodies_[at(link.body)].*result;
    sum.template head<3>() += rounded;
    sum.template tail<3>() += link.lever_arm.cross(rounded);
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::move_bodies(Scalar share) {
  for (Body& body : bodies_) body.motion += share * body.step.template cast<Scalar>();
}

/// The work of the residual forces with the last step [J].
template <class Scalar>
double ImplicitSolver<Scalar>::work_of_bodies() {
  find_body_residuals(&Body::present_residual);
  double work = 0;
  for (const Body& body : bodies_)
    work += static_cast<double>(body.present_residual.dot(body.step));
  return work;
}

#ifndef WEFT_SOLVER_IS_ONE_UNIT
template class ImplicitSolver<float>;
template class ImplicitSolver<double>;
#endif

}  // namespace weft::fast
