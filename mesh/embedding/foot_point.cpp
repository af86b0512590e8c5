#include <weft/mesh/embedding/foot_point.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/LU>

namespace weft {
namespace {

constexpr int kNewtonSteps = 12;
/// Triangles that are tried: the foot is in the nearest one or close to it, or the point has none.
constexpr int kWalk = 16;
/// Weights that are as little negative belong to the triangle: rounding of Newton's method.
constexpr double kInside = 1e-9;
/// Change of the weights at which Newton's method has converged: it is quadratic, the next step is below rounding.
constexpr double kConverged = 1e-11;
/// A foot that is so many times farther than the nearest point belongs to another layer.
constexpr double kFarthest = 2.0;

Triangles edge_neighbors(const Triangles& triangles) {
  std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> at_edge;
  const auto edge = [&](int t, int corner) {
    return std::pair<int, int>(
        std::minmax(triangles((corner + 1) % 3, t), triangles((corner + 2) % 3, t)));
  };
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    for (int corner = 0; corner < 3; ++corner) at_edge[edge(t, corner)].emplace_back(t, corner);
  }
  Triangles neighbors = Triangles::Constant(3, triangles.cols(), -1);
  for (const auto& [key, sides] : at_edge) {
    if (sides.size() != 2) continue;
    neighbors(sides[0].second, sides[0].first) = sides[1].first;
    neighbors(sides[1].second, sides[1].first) = sides[0].first;
  }
  return neighbors;
}

}  // namespace

FootPoints::FootPoints(const Matrix3X<double>& positions, const Triangles& triangles,
                       Matrix3X<double> normals)
    : positions_(positions),
      triangles_(triangles),
      normals_(std::move(normals)),
      neighbors_(edge_neighbors(triangles)),
      tree_(positions, triangles) {}

Vector3<double> FootPoints::normal(const SurfacePoint& point) const {
  return normals_(Eigen::all, triangles_.col(point.triangle)) * point.weights;
}

bool FootPoints::solve(const Vector3<double>& point, int triangle, Vector3<double>& weights,
                       double& height) const {
  const Matrix3<double> x = positions_(Eigen::all, triangles_.col(triangle));
  const Matrix3<double> n = normals_(Eigen::all, triangles_.col(triangle));
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector3<double> normal = n * weights;
    Matrix3<double> jacobian;
    jacobian.col(0) = x.col(1) - x.col(0) + height * (n.col(1) - n.col(0));
    jacobian.col(1) = x.col(2) - x.col(0) + height * (n.col(2) - n.col(0));
    jacobian.col(2) = normal;
    const Vector3<double> residual = point - x * weights - height * normal;
    const Vector3<double> change = jacobian.inverse() * residual;
    if (!change.allFinite()) return false;
    weights += Vector3<double>(-change[0] - change[1], change[0], change[1]);
    height += change[2];
    if (change.head<2>().cwiseAbs().maxCoeff() < kConverged) return true;
  }
  return false;
}

SurfacePoint FootPoints::foot(const Vector3<double>& point) const {
  const SurfacePoint nearest = tree_.closest(point);
  const Matrix3<double> x = positions_(Eigen::all, triangles_.col(nearest.triangle));
  const Vector3<double> away = point - x * nearest.weights;
  const double farthest = kFarthest * away.norm();
  SurfacePoint foot = nearest;
  for (int visit = 0; visit < kWalk && foot.triangle >= 0; ++visit) {
    Vector3<double> weights = foot.weights;
    double height = away.dot(normal(foot).normalized());
    if (!solve(point, foot.triangle, weights, height)) return nearest;
    int corner = 0;
    if (weights.minCoeff(&corner) >= -kInside) {
      if (std::abs(height) *
              (normals_(Eigen::all, triangles_.col(foot.triangle)) * weights).norm() >
          farthest) {
        return nearest;
      }
      return {foot.triangle, weights};
    }
    // Newton's method starts from the middle of the next triangle: no start is nearer to every foot in it.
    foot = {neighbors_(corner, foot.triangle), Vector3<double>::Constant(1.0 / 3.0)};
  }
  return nearest;
}

}  // namespace weft
