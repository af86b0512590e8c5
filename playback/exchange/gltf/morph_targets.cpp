// Morph targets by principal components (Alexa and Mueller, Representing animations by principal components, 2000), computed from
// the Gram matrix of the frames ("method of snapshots", Sirovich 1987), because a cloth has many more coordinates than a recording has frames.
#include <weft/playback/exchange/gltf/morph_targets.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/core/symmetric_matrix.hpp>

namespace weft::scenes {
namespace {

/// The basis of a longer recording comes from so many of its frames, equally spaced: the eigenvalue problem grows with the third power
/// of their number. Weights and errors are those of all frames.
constexpr Eigen::Index kMostFrames = 1024;

/// Modes with a smaller part of the largest eigenvalue are round-off of the Gram matrix.
constexpr double kSmallestEigenvalue = 1e-15;

/// The fitted base of a normal that is shorter is not scaled up to unit length; its direction is then off by as much [rad].
constexpr float kShortestBaseNormal = 1e-3f;

struct Distances {
  double largest = 0.0;  ///< [m]
  double rms = 0.0;      ///< [m]
};

/// Distances of all points in all frames; differences: 3n x frames [m].
Distances distances(const Eigen::MatrixXd& differences) {
  double largest = 0.0;
  double sum = 0.0;
  for (Eigen::Index frame = 0; frame < differences.cols(); ++frame) {
    const Eigen::Map<const Eigen::Matrix3Xd> points(differences.col(frame).data(), 3,
                                                    differences.rows() / 3);
    const auto squares = points.colwise().squaredNorm();
    largest = std::max(largest, squares.maxCoeff());
    sum += squares.sum();
  }
  const auto count = static_cast<double>(differences.size()) / 3;
  return {std::sqrt(largest), std::sqrt(sum / count)};
}

/// Every stride-th frame.
auto some_frames(const Eigen::MatrixXd& motion, Eigen::Index stride) {
  const Eigen::Index count = (motion.cols() + stride - 1) / stride;
  return Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
      motion.data(), motion.rows(), count, Eigen::OuterStride<>(stride * motion.rows()));
}

/// Coefficients of the modes over the frames, the strongest first; without those that are round-off.
Eigen::MatrixXd modes_over_frames(const Eigen::MatrixXd& displacements, Eigen::Index stride) {
  const auto frames = some_frames(displacements, stride);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(frames.cols(), frames.cols());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(frames.transpose());
  const SymmetricModes modes = symmetric_modes(gram);
  const double smallest = kSmallestEigenvalue * modes.values.reverse()[0];
  Eigen::Index rank = 0;
  while (rank < gram.cols() && modes.values.reverse()[rank] > smallest) ++rank;
  return modes.vectors.rowwise().reverse().leftCols(rank);
}

void check_arguments(const Eigen::MatrixXd& motion, double error, int most_targets) {
  if (motion.size() == 0 || motion.rows() % 3 != 0) {
    throw InvalidArgument(fmt::format("morph targets: motion is {} x {}, expected 3n x frames",
                                      motion.rows(), motion.cols()));
  }
  if (!(error > 0.0) || !std::isfinite(error)) {
    throw InvalidArgument(fmt::format("morph targets: error = {} [m], expected > 0", error));
  }
  if (most_targets < 0) {
    throw InvalidArgument(fmt::format("morph targets: at most {}, expected >= 0", most_targets));
  }
}

Eigen::Matrix3Xf points_of(const Eigen::VectorXf& coordinates) {
  return Eigen::Map<const Eigen::Matrix3Xf>(coordinates.data(), 3, coordinates.size() / 3);
}

}  // namespace

MorphTargets fit_morph_targets(Eigen::MatrixXd motion, double error, int most_targets) {
  check_arguments(motion, error, most_targets);
  MorphTargets result;
  // From here on motion is what the rounded base and the rounded targets so far leave over.
  Eigen::VectorXd base = Eigen::VectorXd::Zero(motion.rows());  // before it is rounded
  const auto shift_base = [&](const Eigen::VectorXd& shift) {
    const Eigen::VectorXd before = base.cast<float>().cast<double>();
    base += shift;
    motion.colwise() -= base.cast<float>().cast<double>() - before;
  };
  shift_base(motion.rowwise().mean());
  const Eigen::Index stride = (motion.cols() + kMostFrames - 1) / kMostFrames;
  Distances left = distances(motion);
  Eigen::MatrixXd modes;
  if (left.largest > error && most_targets > 0) modes = modes_over_frames(motion, stride);
  const Eigen::Index most = std::min<Eigen::Index>(most_targets, modes.cols());
  result.weights.resize(most, motion.cols());
  Eigen::Index count = 0;
  for (; count < most && left.largest > error; ++count) {
    const Eigen::VectorXd direction = some_frames(motion, stride) * modes.col(count);
    const Eigen::RowVectorXd factors = direction.transpose() * motion / direction.squaredNorm();
    // The base moves to one end of the mode and the target to the other, so that weights are from 0 to 1: Blender cuts off others.
    const Eigen::VectorXf target =
        ((factors.maxCoeff() - factors.minCoeff()) * direction).cast<float>();
    const Eigen::VectorXd rounded = target.cast<double>();
    if (!(rounded.squaredNorm() > 0.0)) break;  // less than single precision has
    shift_base(factors.minCoeff() * direction);
    // Weights of the rounded target and of what is left now, so that its rounding is made up for by the targets after it.
    const Eigen::RowVectorXd exact = rounded.transpose() * motion / rounded.squaredNorm();
    result.weights.row(count) = exact.cwiseMax(0.0).cwiseMin(1.0).cast<float>();
    motion.noalias() -= rounded * result.weights.row(count).cast<double>();
    result.targets.push_back(points_of(target));
    left = distances(motion);
  }
  result.base = points_of(base.cast<float>());
  result.weights.conservativeResize(count, Eigen::NoChange);
  result.largest_error = left.largest;
  result.rms_error = left.rms;
  result.is_within_error = left.largest <= error;
  return result;
}

MorphNormals fit_morph_normals(const Eigen::MatrixXf& normals, const Eigen::MatrixXf& weights) {
  const Eigen::Index num_targets = weights.rows();
  // The base is fitted too, as a target whose weight is always 1.
  Eigen::MatrixXd factors(num_targets + 1, weights.cols());
  factors.row(0).setOnes();
  factors.bottomRows(num_targets) = weights.cast<double>();
  const Eigen::MatrixXd gram = factors * factors.transpose();
  const Eigen::MatrixXd solution = solve_symmetric(gram, factors);
  Eigen::MatrixXf fitted = normals * solution.transpose().cast<float>();

  MorphNormals result;
  result.base.resize(3, normals.rows() / 3);
  for (Eigen::Index i = 0; i < result.base.cols(); ++i) {
    // A common factor of a point's vectors does not change directions, and the base must have unit length.
    const Eigen::Vector3f fitted_base = fitted.block<3, 1>(3 * i, 0);
    const float length = fitted_base.norm();
    result.base.col(i) =
        length > 0.0f ? Eigen::Vector3f(fitted_base / length) : Eigen::Vector3f::UnitY();
    fitted.middleRows<3>(3 * i) /= std::max(length, kShortestBaseNormal);
    fitted.block<3, 1>(3 * i, 0) = result.base.col(i);
  }
  for (Eigen::Index k = 0; k < num_targets; ++k) {
    result.targets.push_back(points_of(fitted.col(k + 1)));
  }
  double sum = 0.0;
  for (Eigen::Index frame = 0; frame < weights.cols(); ++frame) {
    const Eigen::VectorXf shown = fitted * factors.col(frame).cast<float>();
    for (Eigen::Index i = 0; i < result.base.cols(); ++i) {
      const Eigen::Vector3d a = shown.segment<3>(3 * i).cast<double>();
      const Eigen::Vector3d b = normals.block<3, 1>(3 * i, frame).cast<double>();
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      sum += angle * angle;
    }
  }
  result.rms_error = std::sqrt(3 * sum / static_cast<double>(normals.size()));
  return result;
}

}  // namespace weft::scenes
