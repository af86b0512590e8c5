#include <weft/fast_solver/minimum_degree.hpp>

#include <cstddef>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace weft::fast {

std::vector<int> minimum_degree_order(const SymmetricMatrix& matrix) {
  const int n = matrix.size();
  std::vector<Eigen::Triplet<float>> entries;
  entries.reserve(matrix.columns.size() + matrix.diagonal.size());
  for (int i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    entries.emplace_back(i, i, 1.0F);
    for (int e = matrix.starts[row]; e < matrix.starts[row + 1]; ++e) {
      entries.emplace_back(i, matrix.columns[static_cast<std::size_t>(e)], 1.0F);
    }
  }
  Eigen::SparseMatrix<float> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  std::vector<int> order(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) order[static_cast<std::size_t>(k)] = permutation.indices()[k];
  return order;
}

}  // namespace weft::fast
