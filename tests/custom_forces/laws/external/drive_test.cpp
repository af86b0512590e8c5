#include <weft/custom_forces/laws/external/drive.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kDriveStiffness = 50.0;  // [N/m]
constexpr double kDriveDamping = 3.0;     // [N s/m]

/// Four nodes on the corners of a square about (0.5, 0.5, 2); the first two are the region "hand".
ClothMesh square() {
  Matrix3X<double> corners(3, 4);
  corners << 0, 1, 1, 0,  //
      0, 0, 1, 1,         //
      2, 2, 2, 2;
  ClothMesh mesh = small_mesh(corners, Edges{{0}, {1}});
  mesh.node_sets = {{"hand", {0, 1}}, {"all", {0, 1, 2, 3}}};
  return mesh;
}

LawSpecification drive(const std::string& region, const std::vector<double>& displacement,
                       const std::vector<double>& velocity,
                       const std::vector<double>& angular_velocity) {
  return {.law = "drive",
          .sets = {region},
          .parameters = {{"stiffness", {kDriveStiffness}},
                         {"damping", {kDriveDamping}},
                         {"displacement", displacement},
                         {"velocity", velocity},
                         {"angular_velocity", angular_velocity}}};
}

Matrix3X<double> force_at_time(const LawSpecification& law, const Matrix3X<double>& positions,
                               const Matrix3X<double>& velocities, double time) {
  const ClothMesh mesh = square();
  const auto made = make_law<double>(law, mesh);
  Matrix3X<double> scratch(3, made->scratch_columns());
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, 4);
  made->add_forces({positions, velocities, mesh.masses, time}, scratch, forces);
  return forces;
}

const std::vector<double> kNone = {0, 0, 0};
const Matrix3X<double> kDriveStill = Matrix3X<double>::Zero(3, 4);

TEST(Drive, PullsOnlyTheNodesOfItsRegion) {
  const Matrix3X<double> force = force_at_time(drive("hand", {0.1, 0, -0.2}, kNone, kNone),
                                               square().rest_positions, kDriveStill, 0);
  const Vector3<double> expected = kDriveStiffness * Vector3<double>(0.1, 0, -0.2);
  EXPECT_NEAR((force.col(0) - expected).norm(), 0, kDriveStiffness * kRoundoff);
  EXPECT_NEAR((force.col(1) - expected).norm(), 0, kDriveStiffness * kRoundoff);
  EXPECT_TRUE(force.rightCols(2).isZero(0));
}

TEST(Drive, WithoutRegionsNamedPullsAllOfThem) {
  LawSpecification law = drive("all", {0.1, 0, 0}, kNone, kNone);
  const Matrix3X<double> named = force_at_time(law, square().rest_positions, kDriveStill, 0);
  law.sets.clear();
  EXPECT_EQ(named, force_at_time(law, square().rest_positions, kDriveStill, 0));
}

TEST(Drive, TheTargetMovesOnWithItsVelocity) {
  const double time = 2.5;
  const Vector3<double> velocity(0.4, -0.2, 1.0);
  const Matrix3X<double> force = force_at_time(drive("all", kNone, {0.4, -0.2, 1.0}, kNone),
                                               square().rest_positions, kDriveStill, time);
  const Vector3<double> expected = kDriveStiffness * time * velocity + kDriveDamping * velocity;
  EXPECT_NEAR((force.col(2) - expected).norm(), 0, expected.norm() * kRoundoff);
}

TEST(Drive, LeavesNodesAloneThatMoveAsTheyShould) {
  const double time = 0.7;
  const double rate = 1.3;  // [rad/s] about z
  const Vector3<double> center(0.5, 0.5, 2);
  const Vector3<double> velocity(0.3, 0, -0.1);
  const Matrix3<double> turn =
      Eigen::AngleAxisd(rate * time, Vector3<double>::UnitZ()).toRotationMatrix();
  Matrix3X<double> positions = square().rest_positions;
  Matrix3X<double> velocities(3, 4);
  for (int node = 0; node < 4; ++node) {
    const Vector3<double> arm = turn * (positions.col(node) - center);
    positions.col(node) = center + time * velocity + arm;
    velocities.col(node) = velocity + rate * Vector3<double>(-arm.y(), arm.x(), 0);
  }
  const Matrix3X<double> force =
      force_at_time(drive("all", kNone, {0.3, 0, -0.1}, {0, 0, rate}), positions, velocities, time);
  EXPECT_NEAR(force.norm(), 0, kDriveStiffness * positions.norm() * kRoundoff);
}

TEST(Drive, ARegionTurnsAboutItsOwnCentre) {
  // Half a turn about z swaps the two nodes of the hand, whose centre is (0.5, 0, 2).
  const double pi = std::acos(-1.0);
  LawSpecification law = drive("hand", kNone, kNone, {0, 0, pi});
  law.parameters["damping"] = {0.0};
  const Matrix3X<double> force = force_at_time(law, square().rest_positions, kDriveStill, 1.0);
  EXPECT_NEAR((force.col(0) - kDriveStiffness * Vector3<double>(1, 0, 0)).norm(), 0,
              kDriveStiffness * kRoundoff);
  EXPECT_NEAR((force.col(1) + kDriveStiffness * Vector3<double>(1, 0, 0)).norm(), 0,
              kDriveStiffness * kRoundoff);
}

TEST(Drive, PowerIsTheWorkOfTheHandPerTime) {
  const ClothMesh mesh = square();
  const auto law = make_law<double>(drive("hand", {0.1, 0, 0}, kNone, kNone), mesh);
  Matrix3X<double> velocities = kDriveStill;
  velocities(0, 0) = 2.0;
  const double expected = (kDriveStiffness * 0.1 - kDriveDamping * 2.0) * 2.0;
  EXPECT_NEAR(law->non_conservative_power({mesh.rest_positions, velocities, mesh.masses}), expected,
              kDriveStiffness * kRoundoff);
}

TEST(Drive, RefusesARegionThatTheMeshDoesNotHave) {
  EXPECT_THROW((void)make_law<double>(drive("foot", kNone, kNone, kNone), square()),
               InvalidArgument);
  ClothMesh mesh = square();
  mesh.node_sets[0].nodes = {0, 4};
  EXPECT_THROW((void)make_law<double>(drive("hand", kNone, kNone, kNone), mesh), InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
