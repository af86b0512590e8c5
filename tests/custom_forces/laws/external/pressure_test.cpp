#include <weft/custom_forces/laws/external/pressure.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/mesh/icosphere.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kPressure = 200.0;  // [Pa]

LawSpecification gas(double pressure, double outside = 0.0, double reservoir = 0.0) {
  return {.law = "pressure",
          .sets = {},
          .parameters = {{"pressure", {pressure}},
                         {"outside_pressure", {outside}},
                         {"reservoir_volume", {reservoir}}}};
}

/// A box with one corner at the origin; node number = x + 2 y + 4 z in units of the sides [m].
ClothMesh box(const Vector3<double>& sides) {
  ClothMesh mesh;
  mesh.rest_positions.resize(3, 8);
  for (int node = 0; node < 8; ++node) {
    mesh.rest_positions.col(node) =
        Vector3<double>(node & 1, (node >> 1) & 1, node >> 2).cwiseProduct(sides);
  }
  mesh.triangles.resize(3, 12);
  mesh.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      3, 2, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                //
      1, 3, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  mesh.masses = VectorX<double>::Ones(8);
  return mesh;
}

Matrix3X<double> force_at(const LawSpecification& law, const ClothMesh& mesh,
                          const Matrix3X<double>& positions) {
  return forces_on(law, mesh, positions, Matrix3X<double>::Zero(3, mesh.num_nodes()));
}

double volume_of(const ClothMesh& mesh, const Matrix3X<double>& positions) {
  const Pressure<double> law(checked(gas(1.0)), mesh);
  return law.volume({positions, Matrix3X<double>::Zero(3, mesh.num_nodes()), mesh.masses});
}

std::string error_of(const ClothMesh& mesh) {
  try {
    (void)make_law<double>(gas(kPressure), mesh);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Pressure, OnTheSideOfABoxIsPressureTimesArea) {
  const Vector3<double> sides(0.5, 0.75, 2.0);
  const ClothMesh mesh = box(sides);
  const Matrix3X<double> force = force_at(gas(kPressure), mesh, mesh.rest_positions);
  for (int axis = 0; axis < 3; ++axis) {
    double on_far_side = 0.0;
    for (int node = 0; node < 8; ++node) {
      if ((node >> axis) & 1) on_far_side += force(axis, node);
    }
    const double expected = kPressure * sides.prod() / sides[axis];
    EXPECT_NEAR(on_far_side, expected, expected * kRoundoff) << "axis " << axis;
  }
}

TEST(Pressure, KnowsTheVolumeOfABoxFarFromTheOrigin) {
  const Vector3<double> sides(0.5, 0.75, 2.0);
  const ClothMesh mesh = box(sides);
  const double distance = 1e6;  // [m]
  const Matrix3X<double> far = mesh.rest_positions.array() + distance;
  // The positions themselves are rounded by eps * distance; a sum about the origin would lose
  // eps * distance^3.
  EXPECT_NEAR(volume_of(mesh, far), sides.prod(), kRoundoff * distance * 10);
}

TEST(Pressure, OfASphereIsTheSameOnEveryArea) {
  const ClothMesh mesh = make_icosphere({.radius = 0.4, .frequency = 8});
  const Matrix3X<double> force = force_at(gas(kPressure), mesh, mesh.rest_positions);
  // Virial: the sum of f . x is 3 p V for every closed surface.
  const double virial = force.cwiseProduct(mesh.rest_positions).sum();
  const double expected = 3 * kPressure * volume_of(mesh, mesh.rest_positions);
  EXPECT_NEAR(virial, expected, expected * kRoundoff * std::sqrt(mesh.num_nodes()));
}

TEST(Pressure, ForceIsPressureTimesTheGradientOfTheVolume) {
  const ClothMesh mesh = make_icosphere({.radius = 0.4, .frequency = 2});
  const Matrix3X<double> force = force_at(gas(kPressure), mesh, mesh.rest_positions);
  // The volume is linear in each coordinate, so that a difference is exact at any step.
  const double step = 0.1;  // [m]
  for (Eigen::Index i = 0; i < force.size(); ++i) {
    Matrix3X<double> ahead = mesh.rest_positions;
    Matrix3X<double> behind = mesh.rest_positions;
    ahead.data()[i] += step;
    behind.data()[i] -= step;
    const double gradient = (volume_of(mesh, ahead) - volume_of(mesh, behind)) / (2 * step);
    const double volume = volume_of(mesh, mesh.rest_positions);
    EXPECT_NEAR(force.data()[i], kPressure * gradient, kPressure * volume / step * kRoundoff);
  }
}

TEST(Pressure, TimesVolumeIsConstant) {
  const ClothMesh mesh = box({1, 1, 1});
  const double scale = 1.5;
  const Matrix3X<double> grown = scale * mesh.rest_positions;
  // p = p0 / scale^3 on areas of scale^2
  const Matrix3X<double> expected = force_at(gas(kPressure), mesh, mesh.rest_positions) / scale;
  EXPECT_TRUE(force_at(gas(kPressure), mesh, grown).isApprox(expected, kRoundoff));
}

TEST(Pressure, IsTheDifferenceOfInsideAndOutside) {
  const ClothMesh mesh = box({1, 2, 1});
  EXPECT_TRUE(force_at(gas(kPressure, kPressure), mesh, mesh.rest_positions).isZero(0));
  const Matrix3X<double> expected = force_at(gas(0.25 * kPressure), mesh, mesh.rest_positions);
  EXPECT_TRUE(force_at(gas(kPressure, 0.75 * kPressure), mesh, mesh.rest_positions)
                  .isApprox(expected, kRoundoff));
}

TEST(Pressure, AVastReservoirKeepsItConstant) {
  const ClothMesh mesh = box({1, 1, 1});
  const double reservoir = 1e9;  // [m^3]
  const Matrix3X<double> grown = 2.0 * mesh.rest_positions;
  const Matrix3X<double> expected = 4.0 * force_at(gas(kPressure), mesh, mesh.rest_positions);
  const double change = 7.0 / reservoir;  // of the volume shared: 8 m^3 instead of 1 m^3
  EXPECT_TRUE(
      force_at(gas(kPressure, 0, reservoir), mesh, grown).isApprox(expected, change + kRoundoff));
}

TEST(Pressure, ForcesSumToZero) {
  const ClothMesh mesh = make_icosphere({.radius = 0.4, .frequency = 4, .center = {3, -2, 1}});
  const Matrix3X<double> force = force_at(gas(kPressure), mesh, mesh.rest_positions);
  const double scale = force.cwiseAbs().sum();
  EXPECT_NEAR(force.rowwise().sum().norm(), 0.0, scale * kRoundoff);
}

TEST(Pressure, InACrushedMeshStaysFinite) {
  const ClothMesh mesh = box({1, 1, 1});
  const auto law = make_law<double>(gas(kPressure), mesh);
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, 8);
  const double highest = kPressure / Pressure<double>::kMinVolumeRatio;
  double energy = -1.0;
  for (const double height : {0.02, 0.01, 0.005, 0.0, -0.5}) {
    Matrix3X<double> crushed = mesh.rest_positions;
    crushed.row(2) *= height;
    const Matrix3X<double> force = force_at(gas(kPressure), mesh, crushed);
    const double on_lid = force(2, 4) + force(2, 5) + force(2, 6) + force(2, 7);
    const double expected = std::min(kPressure / std::max(height, 1e-300), highest);
    EXPECT_NEAR(on_lid, height > 0 ? expected : highest, highest * kRoundoff) << height;
    const double now = law->potential_energy({crushed, still, mesh.masses});
    EXPECT_GT(now, energy) << "crushing takes work, also through zero: " << height;
    energy = now;
  }
}

TEST(Pressure, EnergyIsTheWorkOfBoylesLaw) {
  const ClothMesh mesh = box({1, 1, 1});
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, 8);
  for (const double height : {0.5, 0.9, 0.999, 1.001, 1.3, 3.0}) {
    Matrix3X<double> moved = mesh.rest_positions;
    moved.row(2) *= height;
    const auto law = make_law<double>(gas(kPressure), mesh);
    EXPECT_NEAR(law->potential_energy({moved, still, mesh.masses}), -kPressure * std::log(height),
                kPressure * kRoundoff)
        << height;
  }
}

TEST(Pressure, RefusesAnOpenSurface) {
  ClothMesh mesh = box({1, 1, 1});
  mesh.triangles.conservativeResize(3, 11);
  EXPECT_THAT(error_of(mesh), testing::HasSubstr("pressure: the surface of the mesh is open"));
}

TEST(Pressure, RefusesFacesThatLookInward) {
  ClothMesh mesh = box({1, 1, 1});
  mesh.triangles.row(0).swap(mesh.triangles.row(1));
  EXPECT_THAT(error_of(mesh), testing::HasSubstr("pressure: volume at rest = -1.000000 [m^3]"));
}

}  // namespace
}  // namespace weft::forces
