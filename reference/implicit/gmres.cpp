#include <weft/reference/implicit/gmres.hpp>

#include <cmath>
#include <vector>

namespace weft::reference {
namespace {

struct Rotation {
  double c, s;
  void apply(double& a, double& b) const {
    const double old = a;
    a = c * old + s * b;
    b = c * b - s * old;
  }
};

}  // namespace

KrylovOutcome gmres(const LinearMap& a, const LinearMap& preconditioner,
                    const VectorX<double>& right, double tolerance, int max_iterations,
                    VectorX<double>& solution) {
  KrylovOutcome outcome;
  solution.setZero(right.size());
  const double length = right.norm();
  if (!(length > 0.0)) return outcome;
  std::vector<VectorX<double>> basis{right / length};
  std::vector<VectorX<double>> columns;  // of the triangular factor
  std::vector<Rotation> rotations;
  std::vector<double> rotated{length};  // right-hand side of the small problem
  VectorX<double> searched;
  VectorX<double> image(right.size());
  outcome.residual = 1.0;
  while (outcome.iterations < max_iterations && outcome.residual > tolerance) {
    const int k = outcome.iterations++;
    preconditioner(basis.back(), searched);
    a(searched, image);
    VectorX<double> column(k + 2);
    // Modified Gram-Schmidt, twice: the second time takes away what rounding left.
    column.setZero();
    for (int pass = 0; pass < 2; ++pass) {
      for (int i = 0; i <= k; ++i) {
        const double part = basis[static_cast<std::size_t>(i)].dot(image);
        column[i] += part;
        image -= part * basis[static_cast<std::size_t>(i)];
      }
    }
    const double rest = image.norm();
    column[k + 1] = rest;
    for (int i = 0; i < k; ++i) {
      rotations[static_cast<std::size_t>(i)].apply(column[i], column[i + 1]);
    }
    const double radius = std::hypot(column[k], column[k + 1]);
    if (!(radius > 0.0) || !std::isfinite(radius)) {  // a direction that A does not see
      --outcome.iterations;
      break;
    }
    rotations.push_back({column[k] / radius, column[k + 1] / radius});
    rotations.back().apply(column[k], column[k + 1]);
    rotated.push_back(0.0);
    rotations.back().apply(rotated[static_cast<std::size_t>(k)], rotated.back());
    columns.push_back(column);
    outcome.residual = std::abs(rotated.back()) / length;
    if (!(rest > 0.0)) break;
    basis.emplace_back(image / rest);
  }
  VectorX<double> sum = VectorX<double>::Zero(right.size());
  std::vector<double> weights(columns.size());
  for (int i = static_cast<int>(columns.size()) - 1; i >= 0; --i) {
    const auto row = static_cast<std::size_t>(i);
    double value = rotated[row];
    for (std::size_t j = row + 1; j < columns.size(); ++j) value -= columns[j][i] * weights[j];
    weights[row] = value / columns[row][i];
    sum += weights[row] * basis[row];
  }
  if (!columns.empty()) preconditioner(sum, solution);
  return outcome;
}

}  // namespace weft::reference
