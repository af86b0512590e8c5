#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp.

#include <algorithm>

#include <weft/fast_solver/network/element_stiffness.hpp>
#include <weft/fast_solver/network/network_forces.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/step_problem.hpp>

namespace weft::fast {

/// The StepForces of the step that is being solved, if it has any, as Newton's method needs them. At first the constant stiffness of
/// the network stands for theirs; where that is too small, the one of the present shape can take its place, which costs more.
template <class Scalar>
class PresentStepForces {
 public:
  void resize(int num_nodes) {
    positions_.setZero(3, num_nodes);
    forces_.setZero(3, num_nodes);
  }
  /// law: null for none.
  void begin_step(const StepForces<Scalar>* law, NetworkForces<Scalar>& network) {
    law_ = law;
    follows_ = false;
    elements_ = nullptr;
    network.leave_out_bending(false);
  }
  [[nodiscard]] bool empty() const { return law_ == nullptr; }
  /// The linearization follows the shape from the next evaluation on. Returns whether it did not yet, and can.
  [[nodiscard]] bool follow() {
    const bool is_new = law_ != nullptr && !follows_ && law_->has_stiffness();
    follows_ = follows_ || is_new;
    return is_new;
  }
  /// Whether the linearization has the stiffness of the present shape.
  [[nodiscard]] bool has_elements() const { return elements_ != nullptr; }

  /// The forces at positions of all nodes, and, if it is followed and asked for, the stiffness.
  void evaluate(const NodeArrays<Scalar>& positions, bool linearizes,
                NetworkForces<Scalar>& network) {
    if (empty()) return;
    from_arrays<Scalar>(positions, all_nodes(), positions_);
    forces_.setZero();
    law_->add_forces(positions_, forces_);
    if (!follows_ || !linearizes) return;
    elements_ = law_->stiffness(positions_);
    network.leave_out_bending(has_elements());
  }
  /// Those at some nodes [N], and what they add to the blocks of the diagonal if it is asked for [N/m].
  void add(NodeRange nodes, NodeArrays<Scalar>& forces, BlockArrays* blocks) const {
    const int end = empty() ? nodes.begin : std::min(nodes.end, all_nodes().end);
    for (int i = nodes.begin; i < end; ++i) forces.row(i) += forces_.col(i).transpose();
    if (has_elements() && blocks != nullptr) elements_->add_blocks(nodes, *blocks);
  }
  [[nodiscard]] double energy(const NodeArrays<Scalar>& positions) {
    if (empty()) return 0;
    from_arrays<Scalar>(positions, all_nodes(), positions_);
    return law_->energy(positions_);
  }
  /// Strains of one of some parts; all parts are due before add_products().
  void find_strains(int part, int num_parts, const NodeArrays<float>& displacements) const {
    elements_->find_strains(part, num_parts, displacements);
  }
  /// product += stiffness displacements at some nodes [N].
  void add_products(NodeRange nodes, NodeArrays<float>& product) const {
    if (has_elements()) elements_->add_products(nodes, product);
  }

 private:
  [[nodiscard]] NodeRange all_nodes() const { return {0, static_cast<int>(positions_.cols())}; }

  const StepForces<Scalar>* law_ = nullptr;
  bool follows_ = false;
  ElementStiffness* elements_ = nullptr;
  Matrix3X<Scalar> positions_;  ///< as StepForces takes them
  Matrix3X<Scalar> forces_;
};

}  // namespace weft::fast
