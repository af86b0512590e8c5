#include <weft/validation/metrics/distance/vertex_distance.hpp>

#include <cmath>
#include <limits>

#include <fmt/core.h>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void check_shapes(ConstMatrix3XRef<double> a, ConstMatrix3XRef<double> b) {
  if (a.cols() != b.cols() || a.cols() == 0) {
    throw InvalidArgument(fmt::format(
        "vertex distance: nodes = {} and {}, expected the same number >= 1", a.cols(), b.cols()));
  }
}

void check_weights(const VectorX<double>& weights, Eigen::Index num_nodes) {
  if (weights.size() != num_nodes) {
    throw InvalidArgument(fmt::format("vertex distance: weights = {} values, expected {}",
                                      weights.size(), num_nodes));
  }
  if (!weights.allFinite() || weights.minCoeff() < 0 || !(weights.sum() > 0)) {
    throw InvalidArgument(
        "vertex distance: weights have a negative or non-finite value or are all zero, "
        "expected values >= 0 with a positive sum");
  }
}

/// largest, largest_node and the non-finite flag; what does not depend on the weights.
VertexDistance largest_distance(const VectorX<double>& distances) {
  VertexDistance result;
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    if (!std::isfinite(distances[i])) {
      const int node = static_cast<int>(i);
      return {.rms = kNaN, .largest = kNaN, .largest_node = node, .first_non_finite_node = node};
    }
    if (distances[i] > result.largest) {
      result.largest = distances[i];
      result.largest_node = static_cast<int>(i);
    }
  }
  return result;
}

Vector3<double> weighted_mean(ConstMatrix3XRef<double> positions, const VectorX<double>& weights) {
  return positions * weights / weights.sum();
}

}  // namespace

double VertexDistance::rms_relative_to(double length) const {
  if (!std::isfinite(length) || length <= 0) {
    throw InvalidArgument(
        fmt::format("vertex distance: length = {} [m], expected > 0 and finite", length));
  }
  return rms / length;
}

VectorX<double> node_weights(const ClothMesh& mesh) {
  const VectorX<double> areas = node_areas(mesh);
  const double total = areas.sum();
  if (!(total > 0)) return VectorX<double>::Constant(areas.size(), 1.0 / areas.size());
  return areas / total;
}

VectorX<double> node_distances(ConstMatrix3XRef<double> a, ConstMatrix3XRef<double> b) {
  check_shapes(a, b);
  VectorX<double> distances(a.cols());
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const bool finite = a.col(i).allFinite() && b.col(i).allFinite();
    distances[i] = finite ? (a.col(i) - b.col(i)).norm() : kNaN;
  }
  return distances;
}

VertexDistance vertex_distance(ConstMatrix3XRef<double> a, ConstMatrix3XRef<double> b,
                               const VectorX<double>& weights) {
  const VectorX<double> distances = node_distances(a, b);
  check_weights(weights, a.cols());
  VertexDistance result = largest_distance(distances);
  if (!result.first_non_finite_node) {
    result.rms = std::sqrt(weights.dot(distances.cwiseAbs2()) / weights.sum());
  }
  return result;
}

Matrix3X<double> RigidMotion::apply(ConstMatrix3XRef<double> positions) const {
  return (rotation * positions).colwise() + translation;
}

RigidMotion best_rigid_motion(ConstMatrix3XRef<double> moving, ConstMatrix3XRef<double> target,
                              const VectorX<double>& weights) {
  check_shapes(moving, target);
  check_weights(weights, moving.cols());
  if (!moving.allFinite() || !target.allFinite()) {
    return {Matrix3<double>::Constant(kNaN), Vector3<double>::Constant(kNaN)};
  }
  const Vector3<double> moving_center = weighted_mean(moving, weights);
  const Vector3<double> target_center = weighted_mean(target, weights);
  const Matrix3X<double> from = moving.colwise() - moving_center;
  const Matrix3X<double> onto = target.colwise() - target_center;
  const Matrix3<double> covariance = onto * weights.asDiagonal() * from.transpose();
  const Eigen::JacobiSVD<Matrix3<double>> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Turning the weakest axis round keeps a mirror image from being fitted by a reflection; for flat
  // and thinner shapes that axis carries nothing, so the fit loses nothing.
  Vector3<double> signs(1, 1, 1);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs[2] = -1;
  RigidMotion motion;
  motion.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  motion.translation = target_center - motion.rotation * moving_center;
  return motion;
}

VertexDistance aligned_vertex_distance(ConstMatrix3XRef<double> a, ConstMatrix3XRef<double> b,
                                       const VectorX<double>& weights) {
  const VertexDistance plain = vertex_distance(a, b, weights);
  if (plain.first_non_finite_node) return plain;
  return vertex_distance(best_rigid_motion(a, b, weights).apply(a), b, weights);
}

}  // namespace weft::validation
