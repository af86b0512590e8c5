#include <weft/custom_forces/laws/elastic/hinge_torsion.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kRigidity = 2.0;  // D [N m]
/// Rounding of an angle from cross products, relative to a right angle.
constexpr double kAngleRoundoff = 100 * kRoundoff;

LawSpecification hinge_torsion() {
  return {"hinge_torsion", {}, {{"rigidity", {kRigidity}}}};
}

/// Two triangles over the edge from (0, 0, 0) to (0, 1, 0); the second is folded up by this angle
/// towards +z, which is the front.
Matrix3X<double> folded(double angle) {
  Matrix3X<double> positions(3, 4);
  positions << 0, 0, -1, std::cos(angle),  //
      0, 1, 0.5, 0.5,                      //
      0, 0, 0, std::sin(angle);
  return positions;
}

ClothMesh two_triangles(double rest_angle = 0.0) {
  ClothMesh mesh = small_mesh(folded(rest_angle), Edges(2, 0));
  mesh.triangles.resize(3, 2);
  mesh.triangles.col(0) << 0, 1, 2;
  mesh.triangles.col(1) << 1, 0, 3;
  return mesh;
}

Matrix3X<double> hinge_force_at(const ClothMesh& mesh, const Matrix3X<double>& positions) {
  return forces_on(hinge_torsion(), mesh, positions, Matrix3X<double>::Zero(3, positions.cols()));
}

double hinge_energy_at(const ClothMesh& mesh, const Matrix3X<double>& positions) {
  return make_law<double>(hinge_torsion(), mesh)
      ->potential_energy({positions, Matrix3X<double>::Zero(3, positions.cols()), mesh.masses});
}

TEST(HingeTorsion, AWingIsPushedBackByTheMomentOverItsHeight) {
  constexpr double kAngle = 0.3;
  const Matrix3X<double> force = hinge_force_at(two_triangles(), folded(kAngle));
  // l = 1, both heights 1: k = D l / h = D. The wing moves on a circle about the edge.
  EXPECT_NEAR(force.col(3).norm(), kRigidity * kAngle, kAngleRoundoff);
  EXPECT_NEAR(force(2, 3), -kRigidity * kAngle * std::cos(kAngle), kAngleRoundoff);
  EXPECT_NEAR(force(2, 2), -kRigidity * kAngle, kAngleRoundoff);
}

TEST(HingeTorsion, TheEnergyIsThatOfTheAngleOnBothSides) {
  for (const double angle : {-3.0, -1.0, -1e-3, 1e-3, 1.0, 3.0}) {
    EXPECT_NEAR(hinge_energy_at(two_triangles(), folded(angle)), kRigidity * angle * angle / 2,
                10 * kAngleRoundoff)
        << angle;
  }
}

TEST(HingeTorsion, TheMirrorImageOfAFoldIsNotAtRest) {
  const ClothMesh mesh = two_triangles(0.5);
  EXPECT_NEAR(hinge_energy_at(mesh, folded(0.5)), 0, kAngleRoundoff);
  EXPECT_NEAR(hinge_energy_at(mesh, folded(-0.5)), kRigidity / 2, 10 * kAngleRoundoff);
  EXPECT_GT(hinge_force_at(mesh, folded(-0.5))(2, 3), 0) << "back through the flat state";
}

TEST(HingeTorsion, ASquareCellCutBothWaysHasHingesOfHalfTheRigidity) {
  ClothGrid grid;
  grid.nodes = {3, 3};
  grid.size = {2, 2};
  grid.v_axis = {0, 1, 0};
  const ClothMesh mesh = make_cloth_grid(grid);
  Matrix3X<double> bent = mesh.rest_positions;
  constexpr double kLift = 1e-4;                  // [m]
  bent.row(2) = kLift * bent.row(0).cwiseAbs2();  // curvature 2 kLift along x
  // Two cells share the line x = 0, each with two hinges of D / 2 and angle 2 kLift.
  const double expected = 2 * kRigidity * (2 * kLift) * (2 * kLift) / 2;
  EXPECT_NEAR(hinge_energy_at(mesh, bent), expected, expected * 1e-6) << "squares of slopes: 1e-8";
}

TEST(HingeTorsion, AHingeAtAClampCountsTwice) {
  ClothMesh mesh = two_triangles();
  const double free = hinge_energy_at(mesh, folded(0.4));
  mesh.pinned = {0, 1, 2};
  EXPECT_NEAR(hinge_energy_at(mesh, folded(0.4)), 2 * free, 10 * kAngleRoundoff);
  mesh.pinned = {0, 1};
  EXPECT_NEAR(hinge_energy_at(mesh, folded(0.4)), free, 10 * kAngleRoundoff) << "a hem is no clamp";
}

TEST(HingeTorsion, ATriangleWithoutAreaIsRefusedAtRestAndIgnoredInMotion) {
  ClothMesh flat = two_triangles();
  flat.rest_positions.col(3) << 0, 2, 0;
  EXPECT_THROW((void)make_law<double>(hinge_torsion(), flat), InvalidArgument);
  Matrix3X<double> crushed = folded(0.5);
  crushed.col(3) << 0, 0.5, 0;
  EXPECT_EQ(hinge_force_at(two_triangles(), crushed).norm(), 0.0);
}

TEST(HingeTorsion, ThreeTrianglesAtAnEdgeAndTwistedNeighborsAreRefused) {
  ClothMesh three = two_triangles();
  three.triangles.conservativeResize(3, 3);
  three.triangles.col(2) << 0, 1, 3;
  EXPECT_THROW((void)make_law<double>(hinge_torsion(), three), InvalidArgument);
  ClothMesh twisted = two_triangles();
  twisted.triangles.col(1) << 0, 1, 3;
  EXPECT_THROW((void)make_law<double>(hinge_torsion(), twisted), InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
