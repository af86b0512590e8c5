#include <weft/validation/cases/scenes/scene_metrics.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

namespace weft::validation {
namespace {

/// A run of the hang scene in which the whole cloth is shifted by offset [m] times the frame
/// number.
Frames shifted_frames(const SceneMetrics& metrics, int num_frames, double offset) {
  Frames frames;
  for (int f = 0; f < num_frames; ++f) {
    scenes::SceneState state;
    state.time = f * metrics.scene().world.frame_interval;
    const Matrix3X<double> rest = metrics.meshes()[0].rest_positions;
    Matrix3X<double> moved = rest;
    moved.row(1).array() += f * offset;
    state.cloths.push_back({"cloth", moved, Matrix3X<double>::Zero(3, rest.cols())});
    frames.push_back(std::move(state));
  }
  return frames;
}

class SceneMetricsTest : public ::testing::Test {
 protected:
  SceneMetrics metrics_{scenes::load_scene("hang")};
  double interval_ = metrics_.scene().world.frame_interval;
  // Positions of about 1 m carry a rounding of 1e-16; distances are differences of them.
  double tolerance_ = 8 * std::numeric_limits<double>::epsilon();
  double sum_tolerance_ = 1000 * std::numeric_limits<double>::epsilon();  // a sum over 625 nodes
};

TEST_F(SceneMetricsTest, UniformShiftIsItsOwnRmsAndLargestDistance) {
  const Frames still = shifted_frames(metrics_, 11, 0.0);
  const Frames moved = shifted_frames(metrics_, 11, 0.01);
  const double end = 10 * interval_;
  EXPECT_NEAR(metrics_.largest(Quantity::kLargestDistance, moved, still, 0, end), 0.1, tolerance_);
  EXPECT_NEAR(metrics_.largest(Quantity::kRmsDistance, moved, still, 0, end),
              0.1 / metrics_.cloth_size(), tolerance_);
  EXPECT_NEAR(metrics_.largest(Quantity::kLargestDistance, moved, still, 0, 5 * interval_), 0.05,
              tolerance_);
}

TEST_F(SceneMetricsTest, RunThatEndsEarlyIsInfinitelyFar) {
  const Frames still = shifted_frames(metrics_, 11, 0.0);
  const Frames short_run = shifted_frames(metrics_, 4, 0.0);
  EXPECT_TRUE(std::isinf(
      metrics_.largest(Quantity::kLargestDistance, short_run, still, 0, 10 * interval_)));
  EXPECT_EQ(metrics_.largest(Quantity::kLargestDistance, short_run, still, 0, 3 * interval_), 0.0);
}

TEST_F(SceneMetricsTest, ShapeNumbersAreMeansOverNodesAndFrames) {
  const Frames moved = shifted_frames(metrics_, 11, 0.01);
  const double size = metrics_.cloth_size();
  const double height = metrics_.shape_number(Quantity::kMeanHeight, moved[0]);
  EXPECT_NEAR(metrics_.shape_number(Quantity::kMeanHeight, moved[10]), height + 0.1 / size,
              sum_tolerance_);
  EXPECT_NEAR(
      metrics_.mean_shape_number(Quantity::kMeanHeight, moved, 4 * interval_, 10 * interval_),
      height + 0.07 / size, sum_tolerance_);
  EXPECT_NEAR(
      metrics_.largest(Quantity::kMeanHeight, moved, {moved.begin(), moved.end()}, 0, interval_),
      0.0, sum_tolerance_);
  EXPECT_TRUE(std::isnan(
      metrics_.mean_shape_number(Quantity::kMeanHeight, moved, 4 * interval_, 12 * interval_)));
}

TEST_F(SceneMetricsTest, RadiusIsFromTheVerticalThroughTheMiddle) {
  Frames frames = shifted_frames(metrics_, 1, 0.0);
  Matrix3X<double>& nodes = frames[0].cloths[0].positions;
  for (Eigen::Index node = 0; node < nodes.cols(); ++node) {
    nodes.col(node) = Vector3<double>(node % 2 == 0 ? 3.0 : 5.0, static_cast<double>(node), -7.0);
  }
  const double share =
      static_cast<double>((nodes.cols() + 1) / 2) / static_cast<double>(nodes.cols());
  EXPECT_NEAR(metrics_.shape_number(Quantity::kMeanRadius, frames[0]),
              2 * std::sqrt(share * (1 - share)) / metrics_.cloth_size(), sum_tolerance_);
}

TEST_F(SceneMetricsTest, NonFinitePositionIsNeverASmallNumber) {
  const Frames still = shifted_frames(metrics_, 3, 0.0);
  Frames broken = still;
  broken[1].cloths[0].positions(0, 7) = std::nan("");
  EXPECT_TRUE(
      std::isnan(metrics_.largest(Quantity::kLargestDistance, broken, still, 0, 2 * interval_)));
  EXPECT_TRUE(
      std::isnan(metrics_.largest(Quantity::kRmsDistance, broken, still, 0, 2 * interval_)));
}

}  // namespace
}  // namespace weft::validation
