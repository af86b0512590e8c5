#pragma once

#include <vector>

#include <Eigen/Core>

namespace weft::scenes {

/// A moving set of points as a base and a few displacements: the points of frame f are base + sum over k of weights(k, f) targets[k].
/// All numbers are in single precision, as glTF has them, and the errors are those of the rounded numbers.
struct MorphTargets {
  Eigen::Matrix3Xf base;                  ///< 3 x n [m]
  std::vector<Eigen::Matrix3Xf> targets;  ///< 3 x n each [m]
  Eigen::MatrixXf weights;                ///< targets x frames [-], from 0 to 1
  double largest_error =
      0.0;                 ///< [m] largest distance of a point from where it was, over all frames
  double rms_error = 0.0;  ///< [m] root mean square of these distances
  bool is_within_error = true;  ///< largest_error is at most the error that was asked for

  [[nodiscard]] Eigen::Index num_targets() const { return weights.rows(); }
};

/// Principal components of a motion (singular value decomposition of the displacements from the mean of all frames, each frame with the
/// same weight): of all bases with as many targets they leave the smallest sum of squares. Takes the smallest number of them, in the order of their singular
/// values, that keeps every point of every frame within the error, or most_targets if that is not enough.
/// motion: a column for each frame with x y z of all points one after the other, 3n x frames [m], all finite. error: [m], > 0.
/// Throws InvalidArgument for a motion without a point or a frame, and for values out of range.
[[nodiscard]] MorphTargets fit_morph_targets(Eigen::MatrixXd motion, double error,
                                             int most_targets);

/// Unit normals with the weights of the positions: base and targets are fitted to them by least squares, to be normalized after they are summed, as
/// every program that shows glTF does.
struct MorphNormals {
  Eigen::Matrix3Xf base;                  ///< 3 x n, unit vectors
  std::vector<Eigen::Matrix3Xf> targets;  ///< 3 x n each
  double rms_error =
      0.0;  ///< [rad] root mean square of the angle to the true normal, over all frames
};

/// normals: as motion, 3n x frames, unit vectors. weights: MorphTargets::weights.
[[nodiscard]] MorphNormals fit_morph_normals(const Eigen::MatrixXf& normals,
                                             const Eigen::MatrixXf& weights);

}  // namespace weft::scenes
