#pragma once

// Tested by tests/fast_solver/network/element_stiffness_test.cpp.

#include <vector>

#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>

namespace weft::fast {

/// Stiffness of elements with the energy c^2 / 2 each, c a number that four nodes' positions give: the sum of g g^T, g = dc/dx. That is
/// the part of the second derivative that is positive semidefinite however far elements are bent (Gauss-Newton).
class ElementStiffness {
 public:
  using Elements = Eigen::Matrix<int, 4, Eigen::Dynamic>;  ///< node indices
  using Gradients = Eigen::Matrix<float, 12, Eigen::Dynamic>;

  /// Nodes are in [0, num_nodes). Gradients are zero until somebody writes them.
  void set_elements(const Elements& elements, int num_nodes);
  [[nodiscard]] Gradients& gradients() { return gradients_; }  ///< g, by corners [sqrt(N/m)]

  /// g . displacements of the elements of one of some parts [sqrt(N m)]: all parts are due before add_products().
  void find_strains(int part, int num_parts, const NodeArrays<float>& displacements);
  /// product += stiffness displacements at some nodes [N].
  void add_products(NodeRange nodes, NodeArrays<float>& product) const;
  /// blocks += the diagonal's, of some nodes [N/m].
  void add_blocks(NodeRange nodes, BlockArrays& blocks) const;

 private:
  [[nodiscard]] int last_of(NodeRange nodes) const;

  Elements elements_;
  Gradients gradients_;
  std::vector<float> strains_;
  std::vector<int> first_;    ///< for each node: its first in corners_; one more
  std::vector<int> corners_;  ///< 4 element + corner, node by node
};

}  // namespace weft::fast
