#include <weft/custom_forces/laws/elastic/torsion.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <weft/core/error.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kSide = 0.5;       // d [m]
constexpr double kStiffness = 3.0;  // k [N/(m rad)]

LawSpecification torsion(double side_ratio = 1.0) {
  return {"torsion", {}, {{"stiffness", {kStiffness}}, {"side_ratio", {side_ratio}}}};
}

/// A, C, B with sides kSide and second, turned by this angle at C in the plane of x and y.
Matrix3X<double> turned(double angle, double second = kSide) {
  Matrix3X<double> positions = Matrix3X<double>::Zero(3, 3);
  positions(0, 0) = -kSide;
  positions.col(2) << second * std::cos(angle), second * std::sin(angle), 0;
  return positions;
}

ClothMesh line(const Matrix3X<double>& rest_positions) {
  ClothMesh mesh = small_mesh(rest_positions, Edges(2, 0));
  mesh.line_sets.push_back({"line", Triples(3, 1)});
  mesh.line_sets.front().triples << 0, 1, 2;
  return mesh;
}

/// Two triangles over the line, so that its centre has a front: +z turned to +y.
ClothMesh line_with_front(const Matrix3X<double>& rest_positions) {
  Matrix3X<double> positions(3, 5);
  positions.leftCols(3) = rest_positions;
  positions.col(3) << -0.2, 0, 0.4;
  positions.col(4) << 0.2, 0, 0.4;
  ClothMesh mesh = line(positions);
  mesh.masses = VectorX<double>::Ones(5);
  mesh.triangles.resize(3, 2);
  mesh.triangles.col(0) << 0, 1, 3;
  mesh.triangles.col(1) << 1, 2, 4;
  return mesh;
}

Matrix3X<double> force_at(const ClothMesh& mesh, const Matrix3X<double>& positions,
                          double side_ratio = 1.0) {
  return forces_on(torsion(side_ratio), mesh, positions,
                   Matrix3X<double>::Zero(3, positions.cols()));
}

double energy_at(const ClothMesh& mesh, const Matrix3X<double>& positions) {
  return make_law<double>(torsion(), mesh)
      ->potential_energy({positions, Matrix3X<double>::Zero(3, positions.cols()), mesh.masses});
}

TEST(Torsion, ASmallTurnGivesWerthsForces) {
  constexpr double kTurn = 1e-4;  // [rad]
  constexpr double kSecondOrder = kTurn * kTurn;
  const Matrix3X<double> force = force_at(line(turned(0)), turned(kTurn));
  const double end = kStiffness * kSide * kTurn;  // k d theta, along the end's normal
  EXPECT_NEAR(force(1, 2), -end, end * kSecondOrder * 10);
  EXPECT_NEAR(force(1, 0), -end, end * kSecondOrder * 10);
  EXPECT_NEAR(force(1, 1), 2 * end, 2 * end * kSecondOrder * 10);  // k' d' + k'' d''
  EXPECT_NEAR(force(0, 0), 0, end * kTurn);
}

TEST(Torsion, LeverArmsAndSideRatioMakeTheStiffness) {
  constexpr double kSecond = 0.8;  // [m]
  constexpr double kRatio = 0.5;
  constexpr double kTurn = 0.7;  // [rad]
  const double kappa = (kStiffness * kSide * kSide + kRatio * kStiffness * kSecond * kSecond) / 2;
  const Matrix3X<double> force = force_at(line(turned(0, kSecond)), turned(kTurn, kSecond), kRatio);
  EXPECT_NEAR(force.col(2).norm(), kappa * kTurn / kSecond, kappa * kTurn * 10 * kRoundoff);
  EXPECT_NEAR(force.col(0).norm(), kappa * kTurn / kSide, kappa * kTurn * 10 * kRoundoff);
}

TEST(Torsion, TheEnergyOfALargeTurnIsThatOfTheAngle) {
  for (const double turn : {0.01, 0.09, 0.11, 1.0, 2.0, 3.1}) {
    const double kappa = kStiffness * kSide * kSide;
    EXPECT_NEAR(energy_at(line(turned(0)), turned(turn)), kappa * turn * turn / 2, 100 * kRoundoff)
        << turn;
  }
}

TEST(Torsion, APolygonOfEqualTurnsIsInBalance) {
  constexpr int kNodes = 12;
  Matrix3X<double> positions(3, kNodes);
  ClothMesh mesh;
  mesh.masses = VectorX<double>::Ones(kNodes);
  Triples triples(3, kNodes);
  for (int i = 0; i < kNodes; ++i) {
    const double angle = 2 * std::numbers::pi * i / kNodes;
    positions.col(i) << std::cos(angle), std::sin(angle), 0;
    triples.col(i) << i, (i + 1) % kNodes, (i + 2) % kNodes;
  }
  mesh.rest_positions = positions;
  mesh.line_sets.push_back({"ring", triples});
  // At rest as it is, and its energy from straight sides would push every node outward alike.
  EXPECT_LE(force_at(mesh, positions).norm(), 100 * kRoundoff);
}

TEST(Torsion, WhereTheLineIsBentAtRestTheFrontGivesTheSign) {
  constexpr double kTurn = 0.6;  // [rad]
  const ClothMesh mesh = line_with_front(turned(kTurn));
  Matrix3X<double> same = mesh.rest_positions;
  Matrix3X<double> mirrored = same;
  mirrored.row(1) *= -1;
  EXPECT_LE(force_at(mesh, same).norm(), 10 * kRoundoff);
  const double kappa = kStiffness * kSide * kSide;
  EXPECT_NEAR(energy_at(mesh, mirrored), kappa * 4 * kTurn * kTurn / 2, 100 * kRoundoff);
  // It is driven back through the straight line, towards the rest shape.
  EXPECT_GT(force_at(mesh, mirrored)(1, 2), 0);
}

TEST(Torsion, WithoutAFrontTheMirrorImageIsAtRest) {
  const ClothMesh mesh = line(turned(0.6));
  EXPECT_LE(force_at(mesh, turned(-0.6)).norm(), 10 * kRoundoff);
}

TEST(Torsion, ALineFoldedBackHasNoDirectionAndNoForce) {
  const Matrix3X<double> force = force_at(line(turned(0)), turned(std::numbers::pi));
  EXPECT_EQ(force.norm(), 0.0);
  EXPECT_NEAR(energy_at(line(turned(0)), turned(std::numbers::pi)),
              kStiffness * kSide * kSide * std::numbers::pi * std::numbers::pi / 2, 1e-9);
}

TEST(Torsion, ALineThatLosesASideOrFoldsBackHasNoStiffnessEither) {
  const ClothMesh mesh = line(turned(0));
  const auto law = make_law<double>(torsion(), mesh);
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, 3);
  Matrix3X<double> scratch(3, law->scratch_columns());
  Matrix3X<double> collapsed = turned(0);
  collapsed.col(2).setZero();
  for (const Matrix3X<double>& positions : {collapsed, turned(std::numbers::pi)}) {
    Matrix3X<double> product = still;
    law->add_stiffness_product({positions, still, mesh.masses}, turned(0.3), scratch, product);
    EXPECT_EQ(product.norm(), 0.0);
  }
  EXPECT_EQ(force_at(mesh, collapsed).norm(), 0.0);
  EXPECT_EQ(energy_at(mesh, collapsed), 0.0);
}

// Straight and bent lines are computed apart; the sum is over both.
TEST(Torsion, StraightAndBentLinesOfOneMeshAddUp) {
  Matrix3X<double> positions(3, 6);
  positions << turned(0), turned(0.6);
  Matrix3X<double> moved(3, 6);
  moved << turned(0.2), turned(0.9);
  ClothMesh both = line(positions);
  both.line_sets.front().triples.resize(3, 2);
  both.line_sets.front().triples.col(0) << 0, 1, 2;
  both.line_sets.front().triples.col(1) << 3, 4, 5;
  Matrix3X<double> expected(3, 6);
  expected << force_at(line(turned(0)), turned(0.2)), force_at(line(turned(0.6)), turned(0.9));
  EXPECT_LE((force_at(both, moved) - expected).norm(), kRoundoff);
  EXPECT_NEAR(energy_at(both, moved),
              energy_at(line(turned(0)), turned(0.2)) + energy_at(line(turned(0.6)), turned(0.9)),
              kRoundoff);
}

TEST(Torsion, ASideWithoutLengthIsRefused) {
  Matrix3X<double> positions = turned(0);
  positions.col(2).setZero();
  EXPECT_THROW((void)make_law<double>(torsion(), line(positions)), InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
