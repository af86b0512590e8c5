#include <weft/custom_forces/laws/external/wind.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kDensity = 1.25;    // [kg/m^3]
constexpr double kNormalDrag = 1.1;  // [-]
constexpr double kLength = 2.0;      // [m]
constexpr double kWidth = 1.5;       // [m]
constexpr double kArea = kLength * kWidth;

/// A flat sheet with normal +z: length along x, width along y.
ClothMesh sheet() {
  ClothGrid grid;
  grid.nodes = {5, 4};
  grid.size = {kLength, kWidth};
  grid.u_axis = {1, 0, 0};
  grid.v_axis = {0, 1, 0};
  grid.total_mass = 0.6;
  return make_cloth_grid(grid);
}

LawSpecification wind_of(const Vector3<double>& velocity, double tangential_drag = 0.0) {
  return {.law = "wind",
          .sets = {},
          .parameters = {{"velocity", {velocity[0], velocity[1], velocity[2]}},
                         {"air_density", {kDensity}},
                         {"normal_drag", {kNormalDrag}},
                         {"tangential_drag", {tangential_drag}}}};
}

Vector3<double> total_force(const LawSpecification& law, const Vector3<double>& sheet_velocity) {
  const ClothMesh mesh = sheet();
  const Matrix3X<double> velocities = sheet_velocity.replicate(1, mesh.num_nodes());
  return forces_on(law, mesh, mesh.rest_positions, velocities).rowwise().sum();
}

/// Rounding of the sum over the sheet's 24 faces.
constexpr double kSumRoundoff = 24 * kRoundoff;

TEST(Wind, PushesAFlatSheetByItsDynamicPressure) {
  const double speed = 7.0;
  const double expected = 0.5 * kDensity * kNormalDrag * kArea * speed * speed;
  const Vector3<double> force = total_force(wind_of({0, 0, speed}), Vector3<double>::Zero());
  EXPECT_NEAR(force.z(), expected, expected * kSumRoundoff);
  EXPECT_NEAR(force.head<2>().norm(), 0.0, expected * kSumRoundoff);
}

TEST(Wind, FromTheBackPushesTheOtherWay) {
  const Vector3<double> front = total_force(wind_of({0, 0, 3}), Vector3<double>::Zero());
  const Vector3<double> back = total_force(wind_of({0, 0, -3}), Vector3<double>::Zero());
  EXPECT_EQ(front, Vector3<double>(-back));
}

TEST(Wind, AtAnAnglePushesOnlyAlongTheNormal) {
  const Vector3<double> wind(2.0, -1.0, 3.0);
  const double expected = 0.5 * kDensity * kNormalDrag * kArea * wind.z() * wind.z();
  const Vector3<double> force = total_force(wind_of(wind), Vector3<double>::Zero());
  EXPECT_NEAR(force.z(), expected, expected * kSumRoundoff);
  EXPECT_NEAR(force.head<2>().norm(), 0.0, expected * kSumRoundoff);
}

TEST(Wind, AlongTheSheetDragsByTheTangentialCoefficient) {
  const double drag = 0.05;
  const double speed = 5.0;
  const double expected = 0.5 * kDensity * drag * kArea * speed * speed;
  const Vector3<double> force =
      total_force(wind_of({0.6 * speed, 0.8 * speed, 0}, drag), Vector3<double>::Zero());
  EXPECT_NEAR(force.x(), 0.6 * expected, expected * kSumRoundoff);
  EXPECT_NEAR(force.y(), 0.8 * expected, expected * kSumRoundoff);
  EXPECT_NEAR(force.z(), 0.0, expected * kSumRoundoff);
}

TEST(Wind, LeavesASheetAloneThatMovesWithIt) {
  const Vector3<double> wind(2.0, -1.0, 3.0);
  const Vector3<double> force = total_force(wind_of(wind, 0.1), wind);
  // The mean of three equal velocities may be one rounding off; its square is far below that.
  EXPECT_NEAR(force.norm(), 0.0, kRoundoff * kRoundoff * kArea * wind.squaredNorm());
}

TEST(Wind, CarriesASheetAtItsTerminalSpeed) {
  const double gravity = 9.81;
  const double mass = sheet().masses.sum();
  const double terminal = std::sqrt(2 * mass * gravity / (kDensity * kNormalDrag * kArea));
  const Vector3<double> force =
      total_force(wind_of(Vector3<double>::Zero()), Vector3<double>(0, 0, -terminal));
  EXPECT_NEAR(force.z(), mass * gravity, mass * gravity * kSumRoundoff);
}

TEST(Wind, ADegenerateFaceFeelsNothing) {
  const ClothMesh mesh = sheet();
  const Matrix3X<double> one_point = Vector3<double>(1, 2, 3).replicate(1, mesh.num_nodes());
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, mesh.num_nodes());
  EXPECT_TRUE(forces_on(wind_of({3, 4, 5}, 0.1), mesh, one_point, still).isZero(0));
}

TEST(Wind, RefusesATriangleOutsideTheMesh) {
  ClothMesh mesh = sheet();
  mesh.triangles(1, 2) = mesh.num_nodes();
  EXPECT_THROW((void)make_law<double>(wind_of({1, 0, 0}), mesh), InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
