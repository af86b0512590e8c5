#include <weft/playback/exchange/gltf/morph_targets.hpp>

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// Single precision of coordinates up to 2 m, with some room for the sum of the targets. [m]
constexpr double kRounding = 1e-6;

/// Waves of falling strength over a sheet: 3n x frames [m].
Eigen::MatrixXd make_waves(int num_points, int num_frames, int num_waves) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXd motion(3 * num_points, num_frames);
  for (auto& value : motion.col(0)) value = uniform(generator);
  motion.colwise() = Eigen::VectorXd(motion.col(0));
  for (int k = 0; k < num_waves; ++k) {
    const double amplitude = std::pow(0.6, k);
    Eigen::VectorXd shape(3 * num_points);
    for (auto& value : shape) value = amplitude * uniform(generator);
    for (int frame = 0; frame < num_frames; ++frame) {
      motion.col(frame) += std::sin(0.31 * (k + 1) * frame + k) * shape;
    }
  }
  return motion;
}

struct Distances {
  double largest;
  double rms;
};

/// How far the targets show the points from where they were, in double precision. [m]
Distances distances(const MorphTargets& morph, const Eigen::MatrixXd& motion) {
  double largest = 0.0;
  double sum = 0.0;
  for (Eigen::Index frame = 0; frame < motion.cols(); ++frame) {
    Eigen::Matrix3Xd shown = morph.base.cast<double>();
    for (std::size_t k = 0; k < morph.targets.size(); ++k) {
      shown += static_cast<double>(morph.weights(static_cast<Eigen::Index>(k), frame)) *
               morph.targets[k].cast<double>();
    }
    const Eigen::Matrix3Xd off = shown - motion.col(frame).reshaped(3, shown.cols());
    largest = std::max(largest, off.colwise().norm().maxCoeff());
    sum += off.squaredNorm();
  }
  return {largest, std::sqrt(sum / static_cast<double>(motion.size() / 3))};
}

TEST(MorphTargets, StateTheErrorThatTheyHave) {
  const Eigen::MatrixXd motion = make_waves(40, 60, 20);
  for (const double error : {0.3, 0.03, 1e-3, 1e-5}) {
    const MorphTargets morph = fit_morph_targets(motion, error, 64);
    const Distances found = distances(morph, motion);
    EXPECT_TRUE(morph.is_within_error) << error;
    EXPECT_LE(found.largest, error + 1e-12);
    EXPECT_NEAR(morph.largest_error, found.largest, 1e-12);
    EXPECT_NEAR(morph.rms_error, found.rms, 1e-12);
    EXPECT_GE(morph.weights.minCoeff(), 0.0f) << "Blender cuts off what is below";
    EXPECT_LE(morph.weights.maxCoeff(), 1.0f);
  }
}

TEST(MorphTargets, AreAsFewAsPossible) {
  const Eigen::MatrixXd motion = make_waves(40, 60, 20);
  int last_count = 0;
  for (const double error : {0.3, 0.03, 1e-3}) {
    const MorphTargets morph = fit_morph_targets(motion, error, 64);
    const int count = static_cast<int>(morph.num_targets());
    EXPECT_GT(count, last_count);
    last_count = count;
    // The basis that is cut off by one says that it is not within the error, and by how much.
    const MorphTargets cut_off = fit_morph_targets(motion, error, count - 1);
    EXPECT_FALSE(cut_off.is_within_error);
    EXPECT_GT(cut_off.largest_error, error);
    EXPECT_GT(cut_off.rms_error, morph.rms_error);
    EXPECT_NEAR(cut_off.largest_error, distances(cut_off, motion).largest, 1e-12);
  }
}

TEST(MorphTargets, LeaveWhatSingularValuesSay) {
  const Eigen::MatrixXd motion = make_waves(30, 50, 15);
  const Eigen::MatrixXd displacements = motion.colwise() - motion.rowwise().mean();
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(displacements).singularValues();
  for (const int count : {0, 1, 4, 9}) {
    const MorphTargets morph = fit_morph_targets(motion, 1e-9, count);
    ASSERT_EQ(morph.num_targets(), count);
    const double left = values.tail(values.size() - count).norm();
    EXPECT_NEAR(morph.rms_error, left / std::sqrt(30.0 * 50.0), kRounding) << count;
  }
}

TEST(MorphTargets, OfAMotionOfTwoShapesAreTwo) {
  const Eigen::MatrixXd motion = make_waves(25, 40, 2);
  const MorphTargets morph = fit_morph_targets(motion, kRounding, 64);
  EXPECT_EQ(morph.num_targets(), 2);
  EXPECT_TRUE(morph.is_within_error);
}

TEST(MorphTargets, OfWhatStandsStillAreNone) {
  const Eigen::VectorXd points = make_waves(25, 1, 0).col(0);
  const MorphTargets morph = fit_morph_targets(points.replicate(1, 10), kRounding, 64);
  EXPECT_EQ(morph.num_targets(), 0);
  EXPECT_EQ(morph.weights.cols(), 10);
  EXPECT_LT(morph.largest_error, kRounding);
  EXPECT_EQ(fit_morph_targets(points, kRounding, 64).num_targets(), 0) << "a single frame";
}

TEST(MorphTargets, SayWhenSinglePrecisionIsTooCoarse) {
  const Eigen::MatrixXd motion = make_waves(25, 40, 5);
  const MorphTargets morph = fit_morph_targets(motion, 1e-12, 64);
  EXPECT_FALSE(morph.is_within_error);
  EXPECT_LT(morph.largest_error, kRounding);
  EXPECT_NEAR(morph.largest_error, distances(morph, motion).largest, 1e-12);
}

TEST(MorphTargets, OfALongRecordingHoldAllItsFrames) {
  // More frames than the basis is made of: the waves of the frames between are in it too.
  const Eigen::MatrixXd motion = make_waves(4, 2500, 6);
  const MorphTargets morph = fit_morph_targets(motion, 1e-4, 64);
  EXPECT_TRUE(morph.is_within_error);
  EXPECT_LE(morph.num_targets(), 8);
  EXPECT_LE(distances(morph, motion).largest, 1e-4 + 1e-12);
}

TEST(MorphTargets, RefuseWhatIsOutOfRange) {
  const Eigen::MatrixXd motion = make_waves(4, 5, 1);
  EXPECT_THROW((void)fit_morph_targets(motion, 0.0, 64), InvalidArgument);
  EXPECT_THROW((void)fit_morph_targets(motion, std::nan(""), 64), InvalidArgument);
  EXPECT_THROW((void)fit_morph_targets(motion, 1e-3, -1), InvalidArgument);
  EXPECT_THROW((void)fit_morph_targets(Eigen::MatrixXd(3, 0), 1e-3, 64), InvalidArgument);
  EXPECT_THROW((void)fit_morph_targets(motion.topRows(4), 1e-3, 64), InvalidArgument);
}

/// A strip that bends into an arc: positions and unit normals of points along it, by the angle at its end [rad].
struct Strip {
  Eigen::MatrixXd positions;
  Eigen::MatrixXf normals;
};

Strip bending_strip(int num_points, int num_frames, double largest_angle) {
  Strip strip{Eigen::MatrixXd::Zero(3 * num_points, num_frames),
              Eigen::MatrixXf::Zero(3 * num_points, num_frames)};
  for (int frame = 0; frame < num_frames; ++frame) {
    const double step = largest_angle * frame / (num_frames - 1) / num_points;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (int i = 0; i < num_points; ++i) {
      const double angle = step * i;
      strip.positions.col(frame).segment<3>(3 * i) = place;
      strip.normals.col(frame).segment<3>(3 * i) =
          Eigen::Vector3d(-std::sin(angle), std::cos(angle), 0.0).cast<float>();
      place += Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0) / num_points;
    }
  }
  return strip;
}

TEST(MorphNormals, FollowThePositions) {
  const Strip strip = bending_strip(20, 50, 2.0);
  const MorphTargets morph = fit_morph_targets(strip.positions, 1e-4, 64);
  const MorphNormals normals = fit_morph_normals(strip.normals, morph.weights);
  EXPECT_EQ(normals.targets.size(), morph.targets.size());
  EXPECT_LT((normals.base.colwise().norm().array() - 1.0f).abs().maxCoeff(), 1e-6f);
  EXPECT_LT(normals.rms_error, 5e-3);
  // Normals that stand still are what a viewer would show without targets.
  const MorphNormals still = fit_morph_normals(strip.normals, morph.weights.topRows(0));
  EXPECT_GT(still.rms_error, 50 * normals.rms_error);
}

TEST(MorphNormals, HaveUnitLengthWhereTheMeanIsNone) {
  Eigen::MatrixXf normals(3, 2);
  normals << 0, 0, 1, -1, 0, 0;
  Eigen::MatrixXf weights(1, 2);
  weights << 1, -1;
  const MorphNormals result = fit_morph_normals(normals, weights);
  EXPECT_NEAR(result.base.norm(), 1.0f, 1e-6f);
  EXPECT_TRUE(result.targets.front().allFinite());
}

}  // namespace
}  // namespace weft::scenes
