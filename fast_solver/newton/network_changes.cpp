// Changes of the network between steps: pins, kinematic nodes and tears.
// Tested by tests/fast_solver/implicit_solver_test.cpp, tests/fast_solver/torn_network_test.cpp.
#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>

#include <weft/core/error.hpp>
#include <weft/core/index.hpp>
#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::fast {
namespace {

void check_size(const std::vector<bool>& is_free, Eigen::Index num_nodes) {
  if (static_cast<Eigen::Index>(is_free.size()) == num_nodes) return;
  throw InvalidArgument("implicit solver: " + std::to_string(is_free.size()) +
                        " flags of free nodes, expected one for each of the " +
                        std::to_string(num_nodes) + " nodes");
}

}  // namespace

template <class Scalar>
ImplicitSolver<Scalar>::ImplicitSolver(const SpringNetwork& network, const VectorX<double>& masses,
                                       const std::vector<bool>& is_free)
    : forces_(network, static_cast<int>(masses.size())) {
  parts_ = NodePartition(static_cast<int>(masses.size()));
  check_size(is_free, masses.size());
  set_nodes(masses, is_free);
  std::vector<int> all(at(num_nodes()));
  std::iota(all.begin(), all.end(), 0);
  coarse_correction_ = CoarseCorrection(forces_.connectivity_graph(all), forces_.slots());
  change_correction(pinned_);
}

template <class Scalar>
void ImplicitSolver<Scalar>::set_nodes(const VectorX<double>& masses,
                                       const std::vector<bool>& is_free) {
  is_free_ = is_free;
  const Eigen::Index n = masses.size();
  parts_ = NodePartition(static_cast<int>(n));
  list_pinned();
  constrained_.clear();
  constrained_.reserve(at(static_cast<int>(n)));
  contact_of_.assign(at(static_cast<int>(n)), -1);
  has_slid_.assign(at(static_cast<int>(n)), 0);
  normals_.setZero(3, n);
  friction_.resize(n);
  const Eigen::Index num_rows = rows_for(static_cast<int>(n));
  for (auto* holds : {&contact_states_, &contact_states_before_}) {
    holds->assign(static_cast<std::size_t>(num_rows), ContactState::kFree);
  }
  for (Nodes* vectors :
       {&inertial_positions_, &start_positions_, &positions_, &residual_forces_,
        &constraint_forces_, &unmoved_, &last_positions_, &last_results_, &compensation_}) {
    vectors->setZero(num_rows, 3);
  }
  step_forces_.resize(n);
  masses_.setZero(num_rows);
  masses_.head(n) = masses.cast<Scalar>();
  inertia_.setZero(num_rows);
  system_inertia_.setZero(num_rows);
  weights_.setZero(num_rows);
  if (blocks_.rows() == num_rows) return;  // the others keep no number from one step to the next
  blocks_.setZero(num_rows, 6);
  for (Floats* vectors : {&step_, &residual_vector_, &direction_, &direction_product_, &smoothed_,
                          &correction_product_, &work_, &coarse_}) {
    vectors->setZero(num_rows, 3);
  }
  anderson_.resize(num_rows);
  for (Floats& correction : corrections_) correction.setZero(num_rows, 3);
}

template <class Scalar>
void ImplicitSolver<Scalar>::set_free(const std::vector<bool>& is_free) {
  check_size(is_free, num_nodes());
  std::vector<int> changed;
  for (int i = 0; i < num_nodes(); ++i) {
    if (is_free[at(i)] != is_free_[at(i)]) changed.push_back(i);
  }
  if (changed.empty()) return;
  is_free_ = is_free;
  list_pinned();
  change_correction(changed);
}

template <class Scalar>
void ImplicitSolver<Scalar>::change_correction(const std::vector<int>& changed) {
  const Neighborhood neighborhood = forces_.neighborhood_of(changed, 2 * kBasisReach);
  coarse_correction_.set_free(forces_.connectivity_graph(neighborhood.nodes), neighborhood,
                              have_basis_weights(neighborhood.nodes), forces_.slots());
  const Neighborhood surroundings =
      forces_.neighborhood_of(nodes_without_weights(), 2 * kBasisReach);
  coarse_correction_.couple(forces_.connectivity_graph(surroundings.nodes), surroundings.nodes,
                            forces_.slots());
  coarse_correction_.set_masses(masses_.template cast<float>());
  forces_.note_bending(coarse_correction_);
}

// Nodes that are pinned or kinematic, ascending.
template <class Scalar>
std::vector<int> ImplicitSolver<Scalar>::nodes_without_weights() const {
  std::vector<int> result;
  std::set_union(pinned_.begin(), pinned_.end(), kinematic_.begin(), kinematic_.end(),
                 std::back_inserter(result));
  return result;
}

// Flags of some nodes: neither pinned nor kinematic.
template <class Scalar>
std::vector<bool> ImplicitSolver<Scalar>::have_basis_weights(const std::vector<int>& nodes) const {
  std::vector<bool> result;
  for (const int node : nodes) {
    result.push_back(is_free_[at(node)] &&
                     !std::binary_search(kinematic_.begin(), kinematic_.end(), node));
  }
  return result;
}

// Kinematic nodes stay prescribed for many steps, like pins. Therefore coarse basis functions are small near them as well.
template <class Scalar>
void ImplicitSolver<Scalar>::follow_kinematic(const StepProblem<Scalar>& problem) {
  next_kinematic_.clear();
  for (const KinematicNode<Scalar>& kinematic : problem.kinematic)
    next_kinematic_.push_back(kinematic.node);
  std::sort(next_kinematic_.begin(), next_kinematic_.end());
  next_kinematic_.erase(std::unique(next_kinematic_.begin(), next_kinematic_.end()),
                        next_kinematic_.end());
  if (next_kinematic_ == kinematic_) return;
  std::vector<int> changed;
  std::set_symmetric_difference(kinematic_.begin(), kinematic_.end(), next_kinematic_.begin(),
                                next_kinematic_.end(), std::back_inserter(changed));
  kinematic_ = next_kinematic_;
  change_correction(changed);
}

template <class Scalar>
void ImplicitSolver<Scalar>::list_pinned() {
  pinned_.clear();
  for (int i = 0; i < static_cast<int>(is_free_.size()); ++i) {
    if (!is_free_[at(i)]) pinned_.push_back(i);
  }
}

template <class Scalar>
void ImplicitSolver<Scalar>::tear(const SpringNetwork& springs, const std::vector<char>& is_changed,
                                  const VectorX<double>& masses, const std::vector<int>& origins) {
  std::vector<bool> is_free = is_free_;
  for (const int origin : origins) is_free.push_back(is_free_[at(origin)]);
  const std::vector<char> blocks =
      forces_.replace(springs, is_changed, static_cast<int>(masses.size()));
  has_torn_ = true;
  set_nodes(masses, is_free);
  coarse_correction_.add_copies(origins);
  coarse_correction_.note_springs(forces_.slots(), blocks);
  coarse_correction_.set_masses(masses_.template cast<float>());
  forces_.note_bending(coarse_correction_);
  // A copy of a kinematic node is free and has no coarse basis functions yet.
  std::vector<int> of_kinematic;
  const int first = num_nodes() - static_cast<int>(origins.size());
  for (std::size_t k = 0; k < origins.size(); ++k) {
    const bool is_kinematic = std::binary_search(kinematic_.begin(), kinematic_.end(), origins[k]);
    if (is_kinematic) of_kinematic.push_back(first + static_cast<int>(k));
  }
  if (!of_kinematic.empty()) change_correction(of_kinematic);
}

#ifndef WEFT_SOLVER_IS_ONE_UNIT
template class ImplicitSolver<float>;
template class ImplicitSolver<double>;
#endif

}  // namespace weft::fast
