#include <weft/reference/statics/colored_matrix.hpp>

#include <algorithm>

#include <weft/reference/statics/coupling.hpp>

namespace weft::reference {

ColoredMatrix::ColoredMatrix(const Edges& coupled, std::vector<bool> fixed)
    : fixed_(std::move(fixed)), row_of_(fixed_.size(), -1) {
  const int num_nodes = static_cast<int>(fixed_.size());
  for (std::size_t node = 0; node < fixed_.size(); ++node) {
    if (!fixed_[node]) row_of_[node] = 3 * num_free_++;
  }
  colors_ = column_colors(coupled, num_nodes);
  const int num_colors =
      colors_.empty() ? 0 : *std::max_element(colors_.begin(), colors_.end()) + 1;
  blocks_of_color_.resize(static_cast<std::size_t>(num_colors));
  const auto add = [&](int row, int column) {
    if (row_of(row) < 0 || row_of(column) < 0) return;
    const auto color = static_cast<std::size_t>(colors_[static_cast<std::size_t>(column)]);
    blocks_of_color_[color].emplace_back(row, column);
  };
  for (int node = 0; node < num_nodes; ++node) add(node, node);
  for (Eigen::Index e = 0; e < coupled.cols(); ++e) {
    add(coupled(0, e), coupled(1, e));
    add(coupled(1, e), coupled(0, e));
  }
}

Eigen::SparseMatrix<double> ColoredMatrix::assemble(const Product& product) const {
  const auto num_nodes = static_cast<Eigen::Index>(fixed_.size());
  std::vector<Eigen::Triplet<double>> triplets;
  Matrix3X<double> direction(3, num_nodes);
  Matrix3X<double> column(3, num_nodes);
  for (std::size_t color = 0; color < blocks_of_color_.size(); ++color) {
    for (int axis = 0; axis < 3; ++axis) {
      direction.setZero();
      for (std::size_t node = 0; node < fixed_.size(); ++node) {
        if (colors_[node] == static_cast<int>(color) && !fixed_[node]) {
          direction(axis, static_cast<Eigen::Index>(node)) = 1.0;
        }
      }
      product(direction, column);
      for (const auto& [row, source] : blocks_of_color_[color]) {
        for (int k = 0; k < 3; ++k) {
          triplets.emplace_back(row_of(row) + k, row_of(source) + axis, column(k, row));
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(3 * num_free_, 3 * num_free_);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

}  // namespace weft::reference
