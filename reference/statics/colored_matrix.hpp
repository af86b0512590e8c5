#pragma once

// Tested by tests/reference/statics/static_solver_test.cpp.

#include <functional>
#include <utility>
#include <vector>

#include <weft/core/eigen_alignment.hpp>

#include <Eigen/SparseCore>

#include <weft/core/types.hpp>

namespace weft::reference {

/// A sparse matrix over the free nodes of a body that is known by its products alone: one product
/// for all nodes of a colour (coupling.hpp) and each axis shows all of its entries.
class ColoredMatrix {
 public:
  /// product = matrix direction, 3 x n each; direction is 0 on fixed nodes.
  using Product = std::function<void(const Matrix3X<double>& direction, Matrix3X<double>& product)>;

  /// coupled: pairs of nodes between which the matrix has entries; fixed: one flag per node.
  ColoredMatrix(const Edges& coupled, std::vector<bool> fixed);

  [[nodiscard]] int num_free() const { return num_free_; }
  /// First row of a free node, -1 for a fixed one.
  [[nodiscard]] int row_of(int node) const { return row_of_[static_cast<std::size_t>(node)]; }

  /// 3 num_free() x 3 num_free(). Always with the same pattern.
  [[nodiscard]] Eigen::SparseMatrix<double> assemble(const Product& product) const;

 private:
  std::vector<bool> fixed_;
  int num_free_ = 0;
  std::vector<int> row_of_;
  std::vector<int> colors_;
  std::vector<std::vector<std::pair<int, int>>> blocks_of_color_;  // row and column node
};

}  // namespace weft::reference
