#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/rim_folds.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

/// A disc whose rim is r = radius + amplitude cos(mode phi).
Matrix3X<double> folded(const ClothMesh& disc, int mode, double amplitude) {
  Matrix3X<double> positions = disc.rest_positions;
  for (Eigen::Index i = 1; i < positions.cols(); ++i) {
    const double phi = std::atan2(positions(2, i), positions(0, i));
    positions.col(i) *= 1.0 + amplitude * std::cos(mode * phi);
  }
  return positions;
}

/// Chords of 1440 nodes against the smooth rim: sagitta r (2 pi / 1440)^2 / 8, and (m^2 + 1) times
/// that with folds.
double chord_error(int mode) {
  const double step = 2 * std::numbers::pi / 1440;
  return step * step / 8 * (mode * mode + 1);
}

TEST(RimFolds, CountsTheFoldsOfARoundSpecimen) {
  const ClothMesh disc = flat_disc(3, 1440, 1.0);
  for (const int mode : {2, 5, 8, 24}) {
    const auto folds = rim_folds(disc, folded(disc, mode, 0.1), {});
    ASSERT_TRUE(folds);
    EXPECT_EQ(folds->dominant_mode, mode);
    EXPECT_EQ(folds->num_maxima, mode);
    EXPECT_NEAR(folds->amplitudes[static_cast<std::size_t>(mode - kFirstFoldMode)], 0.1,
                chord_error(mode));
    EXPECT_NEAR(folds->mean_radius, 1.0, chord_error(mode));
  }
}

TEST(RimFolds, AFlatDiscHasNone) {
  const ClothMesh disc = flat_disc(3, 1440, 1.0);
  const auto folds = rim_folds(disc, disc.rest_positions, {});
  ASSERT_TRUE(folds);
  EXPECT_EQ(folds->num_maxima, 0);
  for (const double amplitude : folds->amplitudes) EXPECT_LT(amplitude, chord_error(0));
}

TEST(RimFolds, ASquareHasModeFourAndReachesItsCorners) {
  const ClothMesh mesh = flat_cloth(9, 2.0);
  const auto folds = rim_folds(mesh, mesh.rest_positions, {});
  ASSERT_TRUE(folds);
  EXPECT_EQ(folds->dominant_mode, 4);
  EXPECT_NEAR(folds->radii.maxCoeff(), std::sqrt(2.0), kRoundoff);
  EXPECT_NEAR(folds->radii.minCoeff(), 1.0, kRoundoff);
}

TEST(RimFolds, AreNoneWhereTheRimDoesNotSurroundTheAxis) {
  const ClothMesh mesh = flat_cloth(9, 2.0);
  EXPECT_FALSE(rim_folds(mesh, mesh.rest_positions, {.center = {3, 0, 0}}));
  EXPECT_TRUE(rim_folds(mesh, mesh.rest_positions, {.center = {0.9, 50, 0}}));
  Matrix3X<double> broken = mesh.rest_positions;
  broken(2, 40) = kNaN;
  EXPECT_FALSE(rim_folds(mesh, broken, {}));
}

TEST(RimFolds, RefusesSetupsThatMakeNoSense) {
  const ClothMesh mesh = flat_cloth(3, 1.0);
  EXPECT_THROW((void)rim_folds(mesh, mesh.rest_positions, {.num_angles = 48}), InvalidArgument);
  EXPECT_THROW((void)rim_folds(mesh, mesh.rest_positions, {.prominence = kNaN}), InvalidArgument);
  EXPECT_THROW((void)rim_folds(mesh, mesh.rest_positions, {.up = {0, 0, 0}}), InvalidArgument);
  ClothMesh closed = mesh;  // a two-sided triangle has no rim
  closed.triangles = Triangles{{0, 0}, {1, 2}, {4, 1}};
  closed.triangles.col(1) << 0, 4, 1;
  EXPECT_THROW((void)rim_folds(closed, closed.rest_positions, {}), InvalidArgument);
}

TEST(CountMaxima, CountsWhatRisesEnough) {
  EXPECT_EQ(count_maxima(VectorX<double>{{0, 3, 1, 2, 0, 5}}, 0.5), 3);
  EXPECT_EQ(count_maxima(VectorX<double>{{0, 3, 1, 2, 0, 5}}, 1.5), 2);
  EXPECT_EQ(count_maxima(VectorX<double>{{0, 3, 1, 2, 0, 5}}, 4.0), 1);
  EXPECT_EQ(count_maxima(VectorX<double>{{0, 3, 1, 2, 0, 5}}, 5.5), 0);
}

TEST(CountMaxima, PlateausAndEqualTwinsCountOnce) {
  EXPECT_EQ(count_maxima(VectorX<double>{{2, 2, 0, 2, 2, 2}}, 1.0), 1);
  EXPECT_EQ(count_maxima(VectorX<double>{{0, 4, 3.9, 4, 0}}, 1.0), 1);
  EXPECT_EQ(count_maxima(VectorX<double>{{0, 4, 0, 4, 0, 4}}, 1.0), 3);
  EXPECT_EQ(count_maxima(VectorX<double>{{1, 1, 1}}, 0.0), 0);
  EXPECT_EQ(count_maxima(VectorX<double>(0), 0.0), 0);
}

}  // namespace
}  // namespace weft::validation
