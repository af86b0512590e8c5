#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/drape.hpp>
#include <weft/validation/metrics/projected_area.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

/// A boundary of length b is uncertain by at most one cell on either side: area error <= b h.
double raster_error(double boundary, double cell_size) {
  return boundary * cell_size;
}

TEST(ProjectedArea, ASquareOnTheRasterIsExact) {
  const ClothMesh mesh = flat_cloth(5, 2.0);
  const ProjectionRaster raster{.cell_size = 0.0625};  // cell edges on the square's edges
  EXPECT_EQ(projected_area(mesh.rest_positions, mesh.triangles, raster), 4.0);
}

TEST(ProjectedArea, OfATiltedSquareShrinksWithTheCosine) {
  const ClothMesh mesh = flat_cloth(5, 2.0);
  constexpr double kCell = 0.005;
  const auto tilt = Eigen::AngleAxisd(std::numbers::pi / 3, Vector3<double>::UnitX());
  const Matrix3X<double> tilted = tilt.toRotationMatrix() * mesh.rest_positions;
  const auto area = projected_area(tilted, mesh.triangles, {.cell_size = kCell});
  ASSERT_TRUE(area);
  EXPECT_NEAR(*area, 2.0, raster_error(6.0, kCell));
}

TEST(ProjectedArea, CountsOverlapsOnce) {
  const ClothMesh mesh = flat_cloth(5, 2.0);
  Matrix3X<double> folded = mesh.rest_positions;  // fold the half x > 0 over the half x < 0
  folded.row(0) = -folded.row(0).cwiseAbs();
  EXPECT_EQ(projected_area(folded, mesh.triangles, {.cell_size = 0.0625}), 2.0);
}

TEST(ProjectedArea, OfADiscConvergesToPiR2AndDiscAreaCountsTheSame) {
  const ClothMesh disc =
      flat_disc(4, 2000, 1.0);  // the polygon's discretization error: 2e-6 of the area
  double last = 1.0;
  for (const double cell : {0.02, 0.005, 0.00125}) {
    const ProjectionRaster raster{.cell_size = cell};
    const double bound = raster_error(2 * std::numbers::pi, cell);
    EXPECT_NEAR(disc_area(1.0, raster), std::numbers::pi, bound);
    const double area = projected_area(disc.rest_positions, disc.triangles, raster).value();
    EXPECT_NEAR(area, std::numbers::pi, bound);
    EXPECT_NEAR(area, disc_area(1.0, raster),
                bound / 10);  // the errors are shared, not independent
    EXPECT_LT(bound, last);
    last = bound;
  }
}

TEST(ProjectedArea, TheRasterScalesWithTheSpecimen) {
  const double cusick = std::numbers::pi * 0.15 * 0.15;
  EXPECT_NEAR(cusick_cell_size(cusick), 0.25e-3, 0.25e-3 * kRoundoff);
  EXPECT_NEAR(cusick_cell_size(100 * cusick), 2.5e-3, 2.5e-3 * kRoundoff);
  EXPECT_THROW((void)cusick_cell_size(0.0), InvalidArgument);
}

TEST(ProjectedArea, WhatCannotBeCountedIsNone) {
  const ClothMesh mesh = flat_cloth(3, 1.0);
  const ProjectionRaster raster{.cell_size = 0.01};
  for (const double bad : {kNaN, kInfinity, 1e6, 1e300}) {
    Matrix3X<double> positions = mesh.rest_positions;
    positions(0, 0) = positions(2, 0) = bad;
    EXPECT_FALSE(projected_area(positions, mesh.triangles, raster)) << bad;
  }
  EXPECT_THROW((void)projected_area(mesh.rest_positions, mesh.triangles, {.cell_size = 0.0}),
               InvalidArgument);
  EXPECT_THROW((void)disc_area(-1.0, raster), InvalidArgument);
}

/// A disc that lies on a round table and hangs straight down from its edge.
Matrix3X<double> limp(const ClothMesh& disc, double table_radius) {
  Matrix3X<double> positions = disc.rest_positions;
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    const double r = positions.col(i).norm();
    if (r <= table_radius) continue;
    positions.col(i) *= table_radius / r;
    positions(1, i) = table_radius - r;
  }
  return positions;
}

TEST(Drape, BoardIsOneAndLimpClothIsZero) {
  const ClothMesh disc = flat_disc(10, 720, 0.15);
  const DrapeSetup cusick{.support_radius = 0.09};
  const Drape board = measure_drape(disc, disc.rest_positions, cusick);
  EXPECT_EQ(board.coefficient, 1.0);  // the very same cells
  EXPECT_EQ(board.area_ratio, 1.0);
  EXPECT_NEAR(board.cell_size, 0.25e-3, 1e-7);         // the 720-gon is smaller than its circle
  EXPECT_NEAR(board.support_area, 254.5e-4, 0.05e-4);  // BS 5058: 254.5 and 706.9 cm^2
  EXPECT_NEAR(board.rest_area, 706.9e-4, 0.05e-4);
  const Drape hanging = measure_drape(disc, limp(disc, 0.09), cusick);
  const double bound = raster_error(2 * std::numbers::pi * 0.09, board.cell_size);
  EXPECT_NEAR(*hanging.coefficient, 0.0, bound / (board.rest_area - board.support_area));
}

TEST(Drape, OfASphericalCapIsItsProjectedArea) {
  // A disc of radius R wrapped on a sphere of radius S without stretch along its radii: the
  // projection's radius is S sin(R / S).
  constexpr double kRadius = 1.0;
  constexpr double kSphere = 0.8;
  const ClothMesh disc = flat_disc(20, 720, kRadius);
  Matrix3X<double> cap = disc.rest_positions;
  for (Eigen::Index i = 1; i < cap.cols(); ++i) {
    const double r = cap.col(i).norm();
    cap.col(i) *= kSphere * std::sin(r / kSphere) / r;
    cap(1, i) = kSphere * (std::cos(r / kSphere) - 1.0);
  }
  const Drape drape = measure_drape(disc, cap, {.support_radius = 0.3});
  const double projection = kSphere * std::sin(kRadius / kSphere);
  const double area_bound = raster_error(2 * std::numbers::pi * kRadius, drape.cell_size);
  EXPECT_NEAR(*drape.projected_area, std::numbers::pi * projection * projection, area_bound);
  EXPECT_NEAR(*drape.coefficient, (projection * projection - 0.09) / (1.0 - 0.09), area_bound);
}

TEST(Drape, IsTheSameForASpecimenOfAnySizeAndDirection) {
  const ClothMesh small = flat_disc(10, 720, 0.15);
  ClothMesh large = small;
  large.rest_positions *= 20.0;
  const double c = *measure_drape(small, limp(small, 0.12), {.support_radius = 0.09}).coefficient;
  const double scaled =
      *measure_drape(large, 20.0 * limp(small, 0.12), {.support_radius = 1.8}).coefficient;
  // Scaling by 20 rounds positions and cell size; a cell centre on an edge may flip: 1e-3 of about
  // 2e6 cells.
  EXPECT_NEAR(scaled, c, 1e-3);
  const Matrix3<double> turn =
      Eigen::AngleAxisd(std::numbers::pi / 2, Vector3<double>::UnitX()).toRotationMatrix();
  ClothMesh turned = small;
  turned.rest_positions = turn * small.rest_positions;
  const Vector3<double> up = turn * Vector3<double>(0, 1, 0);
  EXPECT_NEAR(*measure_drape(turned, turn * limp(small, 0.12), {.up = up, .support_radius = 0.09})
                   .coefficient,
              c, 1e-3);
}

TEST(Drape, OfAHangingCurtainHasRestAreaButNoProjectedArea) {
  ClothGrid grid;
  grid.nodes = {5, 5};
  grid.size = {2.0, 1.0};
  grid.v_axis = {0, 1, 0};
  const ClothMesh curtain = make_cloth_grid(grid);
  const Drape drape = measure_drape(curtain, curtain.rest_positions, {.cell_size = 0.03125});
  EXPECT_EQ(drape.rest_area, 2.0);
  EXPECT_EQ(drape.support_area, 0.0);
  // Seen from above it is a line: at most two rows of cells.
  EXPECT_LE(*drape.area_ratio, 2 * 0.03125);
}

TEST(Drape, NonFinitePositionsHaveNoDrape) {
  const ClothMesh mesh = flat_cloth(3, 1.0);
  Matrix3X<double> positions = mesh.rest_positions;
  positions(1, 1) = kNaN;
  const Drape drape = measure_drape(mesh, positions, {});
  EXPECT_FALSE(drape.projected_area);
  EXPECT_FALSE(drape.area_ratio);
  EXPECT_FALSE(drape.coefficient);
  EXPECT_NEAR(drape.rest_area, 1.0, raster_error(4.0, drape.cell_size));
}

TEST(Drape, RefusesSetupsThatMakeNoSense) {
  const ClothMesh mesh = flat_cloth(3, 1.0);
  const Matrix3X<double>& x = mesh.rest_positions;
  EXPECT_THROW((void)measure_drape(mesh, x, {.support_radius = 2.0}), InvalidArgument);
  EXPECT_THROW((void)measure_drape(mesh, x, {.up = {0, 0, 0}}), InvalidArgument);
  EXPECT_THROW((void)measure_drape(mesh, x, {.cell_size = 1e-9}), InvalidArgument);
  EXPECT_THROW((void)measure_drape(mesh, x.leftCols(2), {}), InvalidArgument);
  ClothMesh rope = mesh;
  rope.triangles.resize(3, 0);
  EXPECT_THROW((void)measure_drape(rope, x, {}), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
