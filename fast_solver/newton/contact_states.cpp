// Contact states (free, sliding, sticking) and kinematic nodes during a solve (Baraff and Witkin 1998).
// Tested by tests/fast_solver/implicit_solver_test.cpp.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include <weft/fast_solver/implicit_solver.hpp>
#include <weft/fast_solver/newton/node_stiffness.hpp>

#include <weft/core/index.hpp>

namespace weft::fast {
namespace {

/// A node that a body presses sticks once the slip that is left would take this share of its friction to stop, one between fingers
/// where it would bear this share [-].
constexpr double kStopped = 0.01;
/// A node that sticks again after it has slid in the same step bears so many times its bound, for the stiffest drag gives way by a
/// part of that, and it would let go again and again [-].
constexpr double kSticksAgain = 1 + 2 / SlidingFriction<double>::kStiffest;
/// Springs that pull at a node by less than this share of its friction, beside rounding, leave its slip as it is without them [-].
constexpr double kSlack = 0.1;
/// The stiffness of a plane for the coarse correction, over that of the node's springs.
constexpr float kPlane = 2;
/// A moving node's least inertia [N/m], which keeps a quotient finite.
constexpr double kLeastInertia = 1e-30;

/// Removes the normal component of one node's vector.
void take_away(const Vector3<float>& normal, NodeArrays<float>& vectors, int node) {
  vectors.row(node) -= vectors.row(node).dot(normal) * normal.transpose();
}

/// Returns what friction must bear at most for a node to stick [N]. Between two fingers nobody knows which of many nodes bears how
/// much: near their bounds they would change their states again and again. Friction is a drag there, at its stiffest where nothing
/// slips.
template <class Scalar>
Scalar most_without_slip(Scalar bound, Scalar doubt, bool is_pinched, bool sticks_again) {
  if (is_pinched) return std::min(Scalar(kStopped) * bound, bound - doubt);
  return sticks_again ? Scalar(kSticksAgain) * bound : bound - doubt;
}

}  // namespace

// Chooses the contact state of every node (active set). The residual at a sticking node is compared with what Coulomb friction
// can bear.
template <class Scalar>
void ImplicitSolver<Scalar>::decide_contact_states(const StepProblem<Scalar>& problem,
                                                   const NewtonIteration& iteration) {
  const bool can_hold =
      !problem.contacts.empty() || !problem.kinematic.empty() || !problem.bodies.empty();
  have_contact_states_changed_ = false;
  if (!can_hold && constrained_.empty()) return;
  contact_states_before_.swap(contact_states_);
  std::fill(contact_states_.begin(), contact_states_.end(), ContactState::kFree);
  std::fill(contact_of_.begin(), contact_of_.end(), -1);
  if (iteration.is_first && !iteration.continues) {
    std::fill(has_slid_.begin(), has_slid_.end(), 0);
    friction_.begin_step();
  }
  links_.clear();
  for (const KinematicNode<Scalar>& kinematic : problem.kinematic)
    contact_states_[at(kinematic.node)] = ContactState::kFixed;
  const auto gap_at = [&](const PlaneContact<Scalar>& contact, const auto& position) {
    return contact.normal.dot(position - motion_with(contact.body, contact.lever_arm)) -
           contact.offset;
  };
  for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
    const PlaneContact<Scalar>& contact = problem.contacts[c];
    if (!is_free_[at(contact.node)] || contact_states_[at(contact.node)] != ContactState::kFree)
      continue;
    int& best = contact_of_[at(contact.node)];
    if (best < 0 || gap_at(contact, at_node(positions_, contact.node)) <
                        gap_at(problem.contacts[at(best)], at_node(positions_, contact.node))) {
      best = static_cast<int>(c);
    }
  }
  // Each node is that of one contact by now.
  constexpr int kTogether = 32;
  const auto num_contacts = static_cast<int>(problem.contacts.size());
  const int num_parts =
      std::clamp((num_contacts + kTogether - 1) / kTogether, 1, WorkerTeam::kMostParts);
  team_->run(num_parts, [&](int part) {
    const std::int64_t count = num_contacts;
    for (auto c = static_cast<int>(count * part / num_parts);
         c < static_cast<int>(count * (part + 1) / num_parts); ++c) {
      const int i = problem.contacts[at(c)].node;
      if (contact_of_[at(i)] == c) decide_contact_state(problem.contacts[at(c)], iteration);
    }
  });
  for (const PlaneContact<Scalar>& contact : problem.contacts) {
    if (contact_states_[at(contact.node)] == ContactState::kFree)
      contact_of_[at(contact.node)] = -1;  // it lets go
  }
  for (std::size_t c = 0; c < problem.contacts.size() && !bodies_.empty(); ++c) {
    const PlaneContact<Scalar>& contact = problem.contacts[c];
    const int i = contact.node;
    if (contact.body < 0 || contact_of_[at(i)] != static_cast<int>(c)) continue;
    const bool sticks = contact_states_[at(i)] == ContactState::kFixed;
    link(i, contact.body, contact.lever_arm,
         sticks ? Vector3<Scalar>::Zero().eval() : contact.normal);
  }
  for (const KinematicNode<Scalar>& kinematic : problem.kinematic) {
    friction_.release(kinematic.node);
    normals_.col(kinematic.node).setZero();
    if (kinematic.body >= 0)
      link(kinematic.node, kinematic.body, turned(kinematic.body, kinematic.lever_arm),
           Vector3<Scalar>::Zero());
  }
  list_constrained();
  release_bodies();
  have_contact_states_changed_ = contact_states_ != contact_states_before_;
}

template <class Scalar>
void ImplicitSolver<Scalar>::continue_contacts(const ImplicitSolver& other) {
  contact_states_ = other.contact_states_;
  std::fill(contact_of_.begin(), contact_of_.end(), -1);
  list_constrained();
}

// Most nodes are free: eight are looked at together.
template <class Scalar>
void ImplicitSolver<Scalar>::list_constrained() {
  constexpr std::size_t kTogether = sizeof(std::uint64_t) / sizeof(ContactState);
  static_assert(ContactState::kFree == ContactState{} && kNodesPerCacheLine % kTogether == 0);
  constrained_.clear();
  for (std::size_t first = 0; first < contact_states_.size(); first += kTogether) {
    std::uint64_t some = 0;
    std::memcpy(&some, &contact_states_[first], sizeof some);
    if (some == 0) continue;
    for (std::size_t i = first; i < first + kTogether; ++i) {
      if (contact_states_[i] != ContactState::kFree) constrained_.push_back(static_cast<int>(i));
    }
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::find_coarse_roles() {
  coarse_roles_.set(constrained_, links_, contact_states_, [this](int i) {
    const auto stiffness = static_cast<float>(largest_stiffness(i)) + inertia_[i];
    return SlidingNode{i, normals_.col(i), kPlane * stiffness,
                       static_cast<float>(friction_.drags()[i])};
  });
  const bool is_whole =
      coarse_roles_.slide_as_a_whole() && pinned_.empty() && links_.empty() && supports_.empty();
  coarse_correction_.set_translation(
      is_whole ? system_inertia_.sum() : 0,
      is_whole ? coarse_roles_.sliding().front().normal : Vector3<float>::Zero());
}

// One contact's node: what it would do if it stuck decides.
template <class Scalar>
void ImplicitSolver<Scalar>::decide_contact_state(const PlaneContact<Scalar>& contact,
                                                  const NewtonIteration& iteration) {
  const int i = contact.node;
  const bool is_first = iteration.is_first;
  if (is_first && iteration.continues && contact_states_before_[at(i)] != ContactState::kFree) {
    contact_states_[at(i)] = contact_states_before_[at(i)];
    normals_.col(i) = contact.normal.template cast<float>();
    return;
  }
  const Vector3<Scalar> normal = contact.normal;
  const Vector3<Scalar> with_body = motion_with(contact.body, contact.lever_arm);
  const Scalar gap = normal.dot(at_node(positions_, i) - with_body) - contact.offset;
  const Scalar inertia = Scalar(inertia_[i]);
  const bool was_held = !is_first && contact_states_before_[at(i)] != ContactState::kFree;
  const Scalar pressure =
      -normal.dot(at_node(residual_forces_, i)) + inertia * std::max(Scalar(0), -gap);
  const bool is_near = gap + (is_first ? std::min(Scalar(0), first_push(i, normal)) : 0) < 0;
  if (!(contact.squeeze > 0 || (was_held ? pressure > 0 : is_near))) return;
  const Vector3<Scalar> slip =
      at_node(positions_, i) - at_node(start_positions_, i) - contact.motion - with_body;
  Vector3<Scalar> tendency = at_node(residual_forces_, i) + inertia * slip;
  tendency -= normal.dot(tendency) * normal;
  const Scalar most = contact.friction_bound(pressure);
  const Scalar size = tendency.norm();
  // A node that slides, or that a plane has only now been found for, would be drawn back to where the step began: not by what
  // may be rounding.
  const bool did_stick = contact_states_before_[at(i)] == ContactState::kFixed;
  const Vector3<Scalar> along = slip - normal.dot(slip) * normal;
  const Scalar slipped = along.norm();
  const bool was_at_rest = is_first && !(inertia * slipped > most);
  const Scalar rounding = rounding_of_force(i);
  const Scalar doubt = was_at_rest || did_stick ? Scalar(0) : contact.all_friction() * rounding;
  // One that has slid would be drawn back to where the step began, against its springs: friction must bear that too, or the next
  // decision would let it go again (the trial force of Alart and Curnier 1991). Springs of a node that a body presses would be
  // drawn along with it.
  const bool is_pressed = contact.body >= 0 || contact.squeeze > 0;
  const bool has_stopped = is_pressed ? inertia * slipped <= kStopped * most
                                      : (tendency + largest_stiffness(i) * along).norm() <= most;
  // A light node that a body presses could be stopped alone, but not all that have slid with it.
  const bool slides_on =
      is_first && !supports_.empty() && contact_states_before_[at(i)] == ContactState::kOnPlane;
  const bool may_stick = did_stick || has_stopped || (!was_held && !slides_on);
  // Bodies would take what nodes bear beyond their bound, or slip before they have it, for more or less friction than there is.
  const bool is_on_body = contact.body >= 0;
  if (was_held && !did_stick) has_slid_[at(i)] = 1;
  const bool sticks_again = !is_on_body && did_stick && !is_first && has_slid_[at(i)] != 0;
  const bool sticks =
      size <= most_without_slip(most, doubt, contact.squeeze > 0, sticks_again) && may_stick;
  contact_states_[at(i)] = sticks ? ContactState::kFixed : ContactState::kOnPlane;
  normals_.col(i) = normal.template cast<float>();
  if (sticks) return friction_.release(i);
  if (is_on_link(contact))
    return friction_.set_force(i, (-(most / size) * tendency).template cast<float>());
  // Friction that slides is solved for as a drag that has Coulomb's size at the slip that is expected. Forces foretell the slip of a node alone, the motion so far
  // that of others too (iteratively reweighted least squares, which converge for any pressure).
  friction_.set_bound(i, most, resistance_of(i), is_on_body ? Scalar(0) : rounding_of_position(i));
  // Alone, a node has its springs and inertia against it. A drag for that slip would hold nodes that slide together too much:
  // they have their inertia, and slip no farther than so far or, if springs hardly pull at them, than without springs.
  const auto slip_against = [&](Scalar resistance) {
    return (size - most) / std::max(resistance, Scalar(kLeastInertia));
  };
  const Scalar alone = slip_against(inertia + largest_stiffness(i));
  Scalar farthest = slipped;
  if (!is_pressed) {
    const Vector3<Scalar> free_slip =
        slip_of(contact, at_node(inertial_positions_, i), &Body::motion);
    const Scalar pull = (tendency - inertia * free_slip).norm();
    if (pull <= Scalar(kSlack) * most + rounding) farthest = std::max(farthest, free_slip.norm());
  }
  // Rounding of stiff springs' forces is larger than friction, and says nothing of all nodes together.
  const Scalar together = std::min(
      farthest, slip_against(inertia) + rounding / std::max(inertia, Scalar(kLeastInertia)));
  const bool is_foretold = is_first || did_stick || !(slipped > 0);
  const Scalar expected = is_foretold ? std::max(alone, together) : slipped;
  if (is_foretold) return friction_.expect_slip(i, along, expected);
  friction_.set_slip(i, along, !is_on_body && !iteration.is_cautious);
}

// Returns what resists the motion of a node whose neighbors stand still [N/m].
template <class Scalar>
Scalar ImplicitSolver<Scalar>::resistance_of(int node) const {
  return std::max(Scalar(inertia_[node]) + largest_stiffness(node), Scalar(kLeastInertia));
}

// The motion of a node along a surface in the step, relative to it [m].
template <class Scalar>
Vector3<Scalar> ImplicitSolver<Scalar>::slip_of(const PlaneContact<Scalar>& contact,
                                                const Vector3<Scalar>& position,
                                                Vector6 Body::*motion) const {
  Vector3<Scalar> slip = position - at_node(start_positions_, contact.node) - contact.motion;
  if (contact.body >= 0) slip -= motion_at(bodies_[at(contact.body)].*motion, contact.lever_arm);
  return slip - contact.normal.dot(slip) * contact.normal;
}

template <class Scalar>
Scalar ImplicitSolver<Scalar>::largest_stiffness(int node) const {
  return Scalar(forces_.diagonal_blocks().row(node).template head<3>().maxCoeff());
}

template <class Scalar>
void ImplicitSolver<Scalar>::update_friction(const StepProblem<Scalar>& problem, bool is_cautious) {
  for (const int i : constrained_) {
    if (contact_of_[at(i)] < 0 || contact_states_[at(i)] != ContactState::kOnPlane) continue;
    const PlaneContact<Scalar>& contact = problem.contacts[at(contact_of_[at(i)])];
    if (is_on_link(contact)) continue;
    friction_.set_slip(i, slip_of(contact, at_node(positions_, i), &Body::motion),
                       contact.body < 0 && !is_cautious);
  }
}

// Friction on the surfaces behind nodes, and on the bodies that press them there, by what these surfaces bear now: it may be
// many times as much in one iteration as in the next.
template <class Scalar>
void ImplicitSolver<Scalar>::update_supports(const StepProblem<Scalar>& problem,
                                             const NewtonIteration& iteration) {
  supports_.update(positions_, start_positions_, bodies_, iteration.is_first,
                   [&](int node) { return resistance_of(node); });
  for (std::size_t k = 0; k < supports_.all().size() && !iteration.decides; ++k) {
    const int i = supports_.all()[k].node;
    if (contact_of_[at(i)] < 0 || contact_states_[at(i)] != ContactState::kOnPlane) continue;
    const PlaneContact<Scalar>& contact = problem.contacts[at(contact_of_[at(i)])];
    if (is_on_link(contact)) continue;
    friction_.add_to_bound(i, contact.friction * supports_.change_of(k));
    friction_.set_slip(i, slip_of(contact, at_node(positions_, i), &Body::motion), false);
  }
  evaluate();
  energy_before_ = energy(problem, positions_, &Body::motion);
}

// The error of stiff springs' forces that rounded positions cause [N].
template <class Scalar>
Scalar ImplicitSolver<Scalar>::rounding_of_force(int node) const {
  constexpr Scalar kRoundings = 8;
  return kRoundings * largest_stiffness(node) * rounding_of_position(node);
}

template <class Scalar>
Scalar ImplicitSolver<Scalar>::rounding_of_position(int node) const {
  return std::numeric_limits<Scalar>::epsilon() * at_node(positions_, node).cwiseAbs().maxCoeff();
}

// The displacement of a node along a normal by the residual there if its neighbors stood still [m]. Without springs it would
// be too far by much: gas in a ball pushes thirty times as hard as the weight, and the skin holds it back.
template <class Scalar>
Scalar ImplicitSolver<Scalar>::first_push(int node, const Vector3<Scalar>& normal) const {
  const Scalar stiffness = stiffness_along<Scalar>(forces_.diagonal_blocks(), node, normal);
  return normal.dot(at_node(residual_forces_, node)) / (Scalar(inertia_[node]) + stiffness);
}

template <class Scalar>
void ImplicitSolver<Scalar>::project(NodeRange nodes, Floats& vectors) const {
  for (const int i : in_range(pinned_, nodes)) vectors.row(i).setZero();
  for (const int i : in_range(constrained_, nodes)) {
    if (contact_states_[at(i)] == ContactState::kFixed) {
      vectors.row(i).setZero();
    } else if (contact_states_[at(i)] == ContactState::kOnPlane) {
      take_away(normals_.col(i), vectors, i);
    }
  }
}

// Puts nodes in front of the planes of what nothing moves, whatever their contact states.
template <class Scalar>
void ImplicitSolver<Scalar>::put_in_front(const StepProblem<Scalar>& problem) {
  for (const PlaneContact<Scalar>& contact : problem.contacts) {
    if (!is_free_[at(contact.node)] || contact.body >= 0) continue;
    const Scalar gap = contact.normal.dot(at_node(positions_, contact.node)) - contact.offset;
    if (gap < 0) positions_.row(contact.node) -= gap * contact.normal.transpose();
  }
}

// Planes that no iteration has met, and those of a node on several.
template <class Scalar>
void ImplicitSolver<Scalar>::clamp(const StepProblem<Scalar>& problem) {
  was_clamped_ = false;
  const auto is_linked = [&](int node) {
    const int contact = contact_of_[at(node)];
    if (contact >= 0) return problem.contacts[at(contact)].body >= 0;
    return std::any_of(problem.kinematic.begin(), problem.kinematic.end(),
                       [&](const KinematicNode<Scalar>& kinematic) {
                         return kinematic.node == node && kinematic.body >= 0;
                       });
  };
  for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
    const PlaneContact<Scalar>& contact = problem.contacts[c];
    const int i = contact.node;
    if (!is_free_[at(i)] || contact.body >= 0) continue;
    const Scalar gap = contact.normal.dot(at_node(positions_, i)) - contact.offset;
    if (!(gap < 0) || is_linked(i)) continue;
    positions_.row(i) -= gap * contact.normal.transpose();
    was_clamped_ = true;
    if (contact_states_[at(i)] != ContactState::kFree) continue;
    contact_states_[at(i)] = ContactState::kOnPlane;
    contact_of_[at(i)] = static_cast<int>(c);
    normals_.col(i) = contact.normal.template cast<float>();
    friction_.release(i);
    constrained_.push_back(i);
  }
}

template <class Scalar>
double ImplicitSolver<Scalar>::work_of_constraints(const StepProblem<Scalar>& problem,
                                                   const Nodes& positions) const {
  double work = 0;
  for (const int i : constrained_) {
    const Vector3<Scalar> force = at_node(residual_forces_, i);
    work += static_cast<double>(force.dot(step_of(i)));
    // Bodies get the friction of the linear system, wherever the step has led.
    if (!bodies_.empty() || contact_of_[at(i)] < 0) continue;
    if (contact_states_[at(i)] != ContactState::kOnPlane) continue;
    const PlaneContact<Scalar>& contact = problem.contacts[at(contact_of_[at(i)])];
    const Vector3<Scalar> friction =
        friction_.force_at(i, slip_of(contact, at_node(positions, i), &Body::motion));
    const Vector3<Scalar> along = step_of(i) - contact.normal.dot(step_of(i)) * contact.normal;
    work -= static_cast<double>((force + friction).dot(along));
  }
  return work;
}

template <class Scalar>
void ImplicitSolver<Scalar>::find_constraint_forces() {
  if (has_constraint_forces_) constraint_forces_.setZero();
  has_constraint_forces_ = !constrained_.empty();
  for (const int i : constrained_) {
    if (contact_states_[at(i)] == ContactState::kFixed) {
      constraint_forces_.row(i) = -residual_forces_.row(i);
    } else if (contact_states_[at(i)] == ContactState::kOnPlane) {
      const Vector3<Scalar> normal = normals_.col(i).template cast<Scalar>();
      const Scalar push = -normal.dot(at_node(residual_forces_, i));
      constraint_forces_.row(i) =
          (push * normal + friction_.force(i).template cast<Scalar>()).transpose();
    }
  }
}

#ifndef WEFT_SOLVER_IS_ONE_UNIT
template class ImplicitSolver<float>;
template class ImplicitSolver<double>;
#endif

}  // namespace weft::fast
