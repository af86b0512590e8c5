#include <weft/custom_forces/laws/elastic/nonlocal_torsion.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kNonlocalTorsionStiffness = 0.7;  // kappa [N m/rad]
constexpr int kCentre = 12;                        // of 5 x 5 nodes
constexpr int kFar = 14;                           // two cells along x
constexpr double kReach = 2.0;                     // [m] between them

LawSpecification ties() {
  return {"nonlocal_torsion", {}, {{"stiffness", {kNonlocalTorsionStiffness}}}};
}

/// A flat sheet whose centre is tied to the middle of its right side.
ClothMesh tied_sheet() {
  ClothGrid grid;
  grid.nodes = {5, 5};
  grid.size = {4, 4};
  grid.v_axis = {0, 1, 0};
  ClothMesh mesh = make_cloth_grid(grid);
  connect(mesh, "tie", kCentre, {kFar});
  return mesh;
}

/// The far node swung up about the centre.
Matrix3X<double> swung(const ClothMesh& mesh, double angle) {
  Matrix3X<double> positions = mesh.rest_positions;
  positions.col(kFar) =
      positions.col(kCentre) + kReach * Vector3<double>(std::cos(angle), 0, std::sin(angle));
  return positions;
}

Matrix3X<double> nonlocal_force_at(const ClothMesh& mesh, const Matrix3X<double>& positions) {
  return forces_on(ties(), mesh, positions, Matrix3X<double>::Zero(3, positions.cols()));
}

TEST(NonlocalTorsion, AFarNodeIsPushedBackByTheTorqueOverItsDistance) {
  const ClothMesh mesh = tied_sheet();
  for (const double angle : {-2.0, -0.5, 0.05, 1.5, 3.0}) {
    const Vector3<double> force = nonlocal_force_at(mesh, swung(mesh, angle)).col(kFar);
    const Vector3<double> back(std::sin(angle), 0, -std::cos(angle));
    const Vector3<double> expected = kNonlocalTorsionStiffness * angle / kReach * back;
    EXPECT_LE((force - expected).norm(), 1000 * kRoundoff) << angle;
  }
}

TEST(NonlocalTorsion, TurningTheRingAloneTurnsTheWantedDirectionWithIt) {
  const ClothMesh mesh = tied_sheet();
  const Eigen::AngleAxisd turn(0.4, Vector3<double>::UnitY());
  Matrix3X<double> positions = mesh.rest_positions;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (node != kFar) positions.col(node) = turn * Vector3<double>(positions.col(node));
  }
  const Vector3<double> force = nonlocal_force_at(mesh, positions).col(kFar);
  EXPECT_NEAR(force.norm(), kNonlocalTorsionStiffness * 0.4 / kReach, 1000 * kRoundoff);
}

TEST(NonlocalTorsion, ANodeWithoutTrianglesIsRefused) {
  ClothMesh mesh = tied_sheet();
  mesh.triangles.resize(3, 0);
  EXPECT_THROW((void)make_law<double>(ties(), mesh), InvalidArgument);
}

TEST(NonlocalTorsion, ConnectionsAreCheckedWhenTheyAreMade) {
  ClothMesh mesh = tied_sheet();
  EXPECT_THROW(connect(mesh, "tie", 0, {1}), InvalidArgument) << "the name is taken";
  EXPECT_THROW(connect(mesh, "self", 3, {3}), InvalidArgument);
  EXPECT_THROW(connect(mesh, "outside", 3, {25}), InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
