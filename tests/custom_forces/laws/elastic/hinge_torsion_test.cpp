#include <weft/custom_forces/laws/elastic/hinge_torsion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/topology/hinges.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kRigidity = 2.0;  // D [N m]
/// Rounding of an angle from cross products, relative to a right angle.
constexpr double kAngleRoundoff = 100 * kRoundoff;

/// Gradients are sums of a few terms, and meet forces that were made of them in another order.
constexpr double kGradientRounding = 100 * kRoundoff;

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

// The law says from which area on it trusts a normal.
TEST(HingeTorsion, ATriangleIsTrustedFromItsLeastAreaOn) {
  const ClothMesh mesh = two_triangles();
  const auto crushed = [](double height) {
    Matrix3X<double> positions = folded(0.5);
    positions.col(3) << 0, 0.5, height;
    return positions;
  };
  const auto law = make_law<double>(hinge_torsion(), mesh);
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, 4);
  Matrix3X<double> scratch(3, law->scratch_columns());
  const auto product_at = [&](const Matrix3X<double>& positions) -> Matrix3X<double> {
    Matrix3X<double> product = still;
    law->add_stiffness_product({positions, still, mesh.masses}, folded(0.1), scratch, product);
    return product;
  };
  constexpr double kLeast = HingeTorsion<double>::kMinAreaRatio;  // the rest height is 1 m
  for (const double height : {0.0, 0.999 * kLeast}) {
    EXPECT_EQ(hinge_force_at(mesh, crushed(height)).norm(), 0.0) << height;
    EXPECT_EQ(hinge_energy_at(mesh, crushed(height)), 0.0) << height;
    EXPECT_EQ(product_at(crushed(height)).norm(), 0.0) << height;
  }
  const Matrix3X<double> above = crushed(1.001 * kLeast);
  EXPECT_GT(hinge_force_at(mesh, above).norm(), 0.0);
  EXPECT_TRUE(hinge_force_at(mesh, above).allFinite());
  EXPECT_NEAR(hinge_energy_at(mesh, above), kRigidity * std::numbers::pi * std::numbers::pi / 8,
              1e-6)
      << "a wing that stands upright";
}

// The angle pi is -pi as well: which of both rounding gives at rest it must give in motion too.
TEST(HingeTorsion, AFoldThatIsClosedAtRestIsAtRestHoweverItLies) {
  Matrix3X<double> closed(3, 4);
  closed << 0, 0, 1, 0.75,  //
      0, 1, 0.5, 0.25,      //
      0, 0, 0, 0;
  for (int turn = 0; turn < 48; ++turn) {
    // Into each plane and direction of the axes, and to angles between them.
    const int quarters = turn % 4;
    const double more = turn < 24 ? 0.0 : 0.1 * turn;
    const Eigen::Matrix3d rotation =
        (Eigen::AngleAxisd(std::numbers::pi / 2 * quarters + more, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(std::numbers::pi / 2 * (turn / 4 % 3), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    const Matrix3X<double> lying =
        more > 0 ? Matrix3X<double>(rotation * closed)
                 : Matrix3X<double>((rotation.array().round().matrix()) * closed);
    for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 0)}) {
      ClothMesh mesh = small_mesh(lying, Edges(2, 0));
      mesh.triangles.resize(3, 2);
      mesh.triangles.col(0) << from, to, 2;
      mesh.triangles.col(1) << to, from, 3;
      EXPECT_EQ(hinge_force_at(mesh, lying).norm(), 0.0) << turn << " from " << from;
    }
  }
}

// Rounding along the edge, which is long beside the height of a thin triangle, is no angle.
TEST(HingeTorsion, ThinTrianglesKnowTheirAngleInSinglePrecision) {
  constexpr double kHeight = 0.01;  // [m], of edges of 1 m
  double largest = 0;
  for (int sample = 0; sample < 200; ++sample) {
    const double angle = 0.3 + 1e-4 * sample;
    Matrix3X<double> thin(3, 4);
    thin << 0, 0, -kHeight, kHeight * std::cos(angle),  //
        0, 1, 1.0, 0.97,                                //
        0, 0, 0, kHeight * std::sin(angle);
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(0.37 * sample, Eigen::Vector3d(0.48, 0.6, 0.64)).toRotationMatrix();
    ClothMesh mesh = two_triangles();
    mesh.rest_positions.row(0) *= kHeight;
    mesh.rest_positions.row(1) << 0, 1, 1.0, 0.97;
    const Matrix3X<float> rotated = (rotation * thin).cast<float>();
    const VectorX<float> masses = VectorX<float>::Ones(4);
    const Matrix3X<float> still = Matrix3X<float>::Zero(3, 4);
    const double energy = static_cast<double>(
        make_law<float>(hinge_torsion(), mesh)->potential_energy({rotated, still, masses}));
    // Against double precision at the same, rounded positions.
    const double expected = hinge_energy_at(mesh, rotated.cast<double>());
    largest = std::max(largest, std::abs(energy / expected - 1));
  }
  // An angle's error of 60 roundings (0.3 of the least height over the edge's length), twice over the angle.
  EXPECT_LE(largest, 2 * 60 * static_cast<double>(std::numeric_limits<float>::epsilon()) / 0.3);
}

// By the angles that the mesh's own function gives, which has another formula.
TEST(HingeTorsion, TheEnergyOfACrumpledGridIsThatOfAllItsAngles) {
  ClothGrid grid;
  grid.nodes = {23, 17};
  grid.size = {2.2, 1.6};  // square cells
  const ClothMesh mesh = make_cloth_grid(grid);
  std::srand(7);
  const Matrix3X<double> crumpled =
      mesh.rest_positions + 0.04 * Matrix3X<double>::Random(3, mesh.num_nodes());
  const double squares = hinge_angles(crumpled, bending_hinges(mesh)).squaredNorm();
  const double expected = kRigidity / 2 * squares / 2;
  EXPECT_NEAR(hinge_energy_at(mesh, crumpled), expected, 1e-12 * expected);
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

HingeTorsion<double>::Gradients gradients_at(const ClothMesh& mesh,
                                             const Matrix3X<double>& positions) {
  const auto law = make_law<double>(hinge_torsion(), mesh);
  const auto& hinges = dynamic_cast<const HingeTorsion<double>&>(*law);
  HingeTorsion<double>::Gradients gradients(12, hinges.hinges().cols());
  hinges.get_gradients(positions, gradients);
  return gradients;
}

TEST(HingeTorsion, GradientsTimesTheRootOfTwiceTheEnergyAreForces) {
  const ClothMesh mesh = two_triangles();
  for (const double angle : {-2.5, -0.4, 0.4, 2.5}) {
    const Matrix3X<double> positions = folded(angle);
    const Matrix3X<double> force = hinge_force_at(mesh, positions);
    // The law's angle is negative where wings are folded to the front.
    const double root = std::copysign(std::sqrt(2 * hinge_energy_at(mesh, positions)), angle);
    const auto gradients = gradients_at(mesh, positions);
    const auto law = make_law<double>(hinge_torsion(), mesh);
    const auto& nodes = dynamic_cast<const HingeTorsion<double>&>(*law).hinges();
    for (int corner = 0; corner < 4; ++corner) {
      const Vector3<double> expected = force.col(nodes(corner, 0));
      const Vector3<double> found = root * gradients.col(0).segment<3>(3 * corner);
      EXPECT_LT((found - expected).norm(), kGradientRounding * expected.norm()) << angle;
    }
  }
}

TEST(HingeTorsion, SquaresOfGradientsAreTheStiffnessWithoutMoments) {
  ClothGrid grid;
  grid.nodes = {5, 4};
  ClothMesh mesh = make_cloth_grid(grid);
  for (auto x : mesh.rest_positions.colwise()) x.y() += 0.8 * x.x() * x.x() - 0.3 * x.x() * x.z();
  const auto law = make_law<double>(hinge_torsion(), mesh);
  const auto& nodes = dynamic_cast<const HingeTorsion<double>&>(*law).hinges();
  const auto gradients = gradients_at(mesh, mesh.rest_positions);
  const Matrix3X<double> displacements = Matrix3X<double>::Random(3, mesh.num_nodes());
  Matrix3X<double> product = Matrix3X<double>::Zero(3, mesh.num_nodes());
  for (Eigen::Index h = 0; h < nodes.cols(); ++h) {
    double strain = 0;
    for (int corner = 0; corner < 4; ++corner) {
      strain += gradients.col(h).segment<3>(3 * corner).dot(displacements.col(nodes(corner, h)));
    }
    for (int corner = 0; corner < 4; ++corner) {
      product.col(nodes(corner, h)) += strain * gradients.col(h).segment<3>(3 * corner);
    }
  }
  Matrix3X<double> expected = Matrix3X<double>::Zero(3, mesh.num_nodes());
  Matrix3X<double> scratch(3, law->scratch_columns());
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, mesh.num_nodes());
  law->add_stiffness_product({mesh.rest_positions, still, mesh.masses}, displacements, scratch,
                             expected);
  EXPECT_GT(expected.norm(), 1);
  EXPECT_LT((product + expected).norm(), kGradientRounding * expected.norm());
}

}  // namespace
}  // namespace weft::forces
