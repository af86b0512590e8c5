#include <weft/validation/metrics/rim_folds.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

void check(const ClothMesh& mesh, ConstMatrix3XRef<double> positions, const RimSetup& setup) {
  if (positions.cols() != mesh.num_nodes()) {
    throw InvalidArgument(fmt::format("rim folds: positions = {} nodes, expected {}",
                                      positions.cols(), mesh.num_nodes()));
  }
  if (setup.num_angles <= 2 * kLastFoldMode + 1) {
    throw InvalidArgument(fmt::format("rim folds: num_angles = {}, expected >= {}",
                                      setup.num_angles, 2 * kLastFoldMode + 2));
  }
  if (!(setup.prominence >= 0)) {
    throw InvalidArgument(
        fmt::format("rim folds: prominence = {} [m], expected >= 0", setup.prominence));
  }
  if (!setup.up.allFinite() || !(setup.up.norm() > 0) || !setup.center.allFinite()) {
    throw InvalidArgument("rim folds: up or center, expected finite and a direction not zero");
  }
}

std::vector<std::pair<int, int>> rim_edges(const Triangles& triangles) {
  std::map<std::pair<int, int>, int> uses;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      ++uses[std::minmax({triangles(k, t), triangles((k + 1) % 3, t)})];
    }
  }
  std::vector<std::pair<int, int>> edges;
  for (const auto& [edge, count] : uses) {
    if (count == 1) edges.push_back(edge);
  }
  if (edges.empty()) throw InvalidArgument("rim folds: the mesh has no rim, expected an open mesh");
  return edges;
}

/// Raises radii where the edge p q is crossed by the ray of that angle.
void add_edge(const Eigen::Vector2d& p, const Eigen::Vector2d& q, VectorX<double>& radii) {
  const double cross = p.x() * q.y() - p.y() * q.x();
  const double start = std::atan2(p.y(), p.x());
  const double turn = std::atan2(cross, p.dot(q));  // the short way round, -pi to pi
  const double per_turn = static_cast<double>(radii.size()) / kFullTurn;
  const double low = std::min(start, start + turn) * per_turn;
  const double high = std::max(start, start + turn) * per_turn;
  // Widened, so that a ray through a node meets one of its edges in spite of rounding.
  constexpr double kSlack = 1e-9;  // [samples], far above eps times the number of samples
  const auto first = static_cast<long>(std::ceil(low - kSlack));
  const auto last = static_cast<long>(std::floor(high + kSlack));
  for (long k = first; k <= last; ++k) {
    const double phi = static_cast<double>(k) / per_turn;
    const Eigen::Vector2d ray(std::cos(phi), std::sin(phi));
    const Eigen::Vector2d edge = q - p;
    const double denominator = ray.x() * edge.y() - ray.y() * edge.x();
    // An edge that points along the ray is crossed in its whole length: its far end counts.
    const double radius = denominator == 0 ? std::max(p.norm(), q.norm()) : cross / denominator;
    const auto size = static_cast<long>(radii.size());
    const long index = ((k % size) + size) % size;
    radii[index] = std::max(radii[index], std::min(radius, std::max(p.norm(), q.norm())));
  }
}

}  // namespace

int count_maxima(const VectorX<double>& closed_curve, double prominence) {
  std::vector<double> values;  // without repeated neighbors, so that a plateau is one point
  for (const double value : closed_curve) {
    if (values.empty() || values.back() != value) values.push_back(value);
  }
  while (values.size() > 1 && values.back() == values.front()) values.pop_back();
  const std::size_t n = values.size();
  if (n < 2) return 0;
  int count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (values[i] <= values[(i + 1) % n] || values[i] <= values[(i + n - 1) % n]) continue;
    // Walks away until higher ground and notes the lowest point on the way. Backwards, equally high
    // ground stops it too: so one of two equal maxima is the child of the other.
    const auto lowest = [&](std::size_t step, bool equal_stops) {
      double low = values[i];
      for (std::size_t k = 1; k < n; ++k) {
        const double value = values[(i + k * step) % n];
        if (value > values[i] || (equal_stops && value == values[i])) break;
        low = std::min(low, value);
      }
      return low;
    };
    const double valley = std::max(lowest(1, false), lowest(n - 1, true));
    if (values[i] - valley >= prominence) ++count;
  }
  return count;
}

std::optional<RimFolds> rim_folds(const ClothMesh& mesh, ConstMatrix3XRef<double> positions,
                                  const RimSetup& setup) {
  check(mesh, positions, setup);
  const std::vector<std::pair<int, int>> edges = rim_edges(mesh.triangles);
  if (!positions.allFinite()) return std::nullopt;
  const Vector3<double> up = setup.up.normalized();
  Eigen::Matrix<double, 2, 3> projection;
  projection.row(0) = up.unitOrthogonal().transpose();
  projection.row(1) = up.cross(up.unitOrthogonal()).transpose();
  const Eigen::Matrix2Xd flat = projection * (positions.colwise() - setup.center);
  RimFolds folds;
  folds.radii = VectorX<double>::Constant(setup.num_angles, -1.0);  // -1: no crossing seen yet
  for (const auto& [i, j] : edges) add_edge(flat.col(i), flat.col(j), folds.radii);
  if (folds.radii.minCoeff() < 0) return std::nullopt;
  folds.mean_radius = folds.radii.mean();
  for (int mode = kFirstFoldMode; mode <= kLastFoldMode; ++mode) {
    std::complex<double> sum = 0.0;
    for (int k = 0; k < setup.num_angles; ++k) {
      sum += folds.radii[k] * std::polar(1.0, -kFullTurn * mode * k / setup.num_angles);
    }
    folds.amplitudes[static_cast<std::size_t>(mode - kFirstFoldMode)] =
        2.0 * std::abs(sum) / setup.num_angles;
  }
  const auto largest = std::max_element(folds.amplitudes.begin(), folds.amplitudes.end());
  folds.dominant_mode = kFirstFoldMode + static_cast<int>(largest - folds.amplitudes.begin());
  folds.num_maxima = count_maxima(folds.radii, setup.prominence);
  return folds;
}

}  // namespace weft::validation
