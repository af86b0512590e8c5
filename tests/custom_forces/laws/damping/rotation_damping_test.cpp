#include <weft/custom_forces/laws/damping/rotation_damping.hpp>

#include <gtest/gtest.h>
#include <weft/core/error.hpp>

#include "tests/custom_forces/small_bodies.hpp"

namespace weft::forces {
namespace {

constexpr double kRotationDampingRate = 0.8;      // [1/s]
constexpr double kRotationDampingTimeStep = 0.3;  // [s]
const LawSpecification kRotationDampingLaw{
    .law = "rotation_damping", .sets = {}, .parameters = {{"rate", {kRotationDampingRate}}}};

/// Sums of 7 terms of size 10 (kg m^2/s), divided by an inertia of condition 10: round-off.
constexpr double kRotationDampingSumRoundoff = 100 * kRoundoff;

TEST(RotationDamping, AngularMomentumDecaysInMagnitudeAndDirection) {
  const ClothMesh mesh = lopsided_body();
  const Matrix3X<double> before = arbitrary(7, 1);
  const Matrix3X<double> after =
      advanced(kRotationDampingLaw, mesh, before, kRotationDampingTimeStep);
  const Vector3<double> expected =
      std::exp(-kRotationDampingRate * kRotationDampingTimeStep) * spin_momentum(mesh, before);
  EXPECT_GT(expected.norm(), 0.1);
  EXPECT_LT((spin_momentum(mesh, after) - expected).norm(), kRotationDampingSumRoundoff);
  EXPECT_LT((momentum(mesh, after) - momentum(mesh, before)).norm(), kRotationDampingSumRoundoff);
}

TEST(RotationDamping, WhatIsNotRotationStays) {
  const ClothMesh mesh = lopsided_body();
  const Matrix3X<double> before = arbitrary(7, 1);
  const Matrix3X<double> lost =
      before - advanced(kRotationDampingLaw, mesh, before, kRotationDampingTimeStep);
  // What is taken away is a rigid rotation about the centre of mass: nothing of it is left after
  // the law has acted for ever.
  EXPECT_GT(lost.norm(), 0.1);
  EXPECT_LT(advanced(kRotationDampingLaw, mesh, lost, 1e3).norm(), kRotationDampingSumRoundoff);
}

TEST(RotationDamping, TranslationFeelsNothing) {
  const ClothMesh mesh = lopsided_body();
  const Matrix3X<double> before = rigid_motion(mesh, {0, 0, 0}, {3, -2, 1});
  EXPECT_LT((advanced(kRotationDampingLaw, mesh, before, kRotationDampingTimeStep) - before).norm(),
            kRotationDampingSumRoundoff);
  EXPECT_LT(forces_on(kRotationDampingLaw, mesh, mesh.rest_positions, before).norm(),
            kRotationDampingSumRoundoff);
}

TEST(RotationDamping, ForceIsAgainstTheSpinOfEachNode) {
  // Nodes of 1 kg at a distance of 2 m from the axis, 3 rad/s.
  Matrix3X<double> positions(3, 4);
  positions << 2, 0, -2, 0, 0, 2, 0, -2, 0, 0, 0, 0;
  const ClothMesh mesh = small_mesh(positions, Edges(2, 0));
  const Matrix3X<double> spin = rigid_motion(mesh, {0, 0, 3}, {0, 0, 0});
  const Matrix3X<double> force = forces_on(kRotationDampingLaw, mesh, positions, spin);
  EXPECT_NEAR(force(1, 0), -kRotationDampingRate * 6, 6 * kRoundoff);
  EXPECT_NEAR(force(0, 1), kRotationDampingRate * 6, 6 * kRoundoff);
  EXPECT_NEAR(force(2, 1), 0.0, kRoundoff);
}

TEST(RotationDamping, ADumbbellTurnsMoreSlowlyAndSwingsOn) {
  const ClothMesh mesh = one_spring(2.0);
  Matrix3X<double> before(3, 2);
  before << 0.5, -0.5, 1, -1, 0, 0;  // along the line, and about z
  const Matrix3X<double> after =
      advanced(kRotationDampingLaw, mesh, before, kRotationDampingTimeStep);
  EXPECT_NEAR(after(1, 0), std::exp(-kRotationDampingRate * kRotationDampingTimeStep), kRoundoff);
  EXPECT_NEAR(after(0, 0), 0.5, kRoundoff);
}

TEST(RotationDamping, AThinRodIsNoSpecialCase) {
  // From a line to a triangle as thick as it is long: L decays by the same factor on both sides of
  // the thickness at which the body counts as a line. There the moment about the line is kCollinear
  // of the others, and so is what is left out.
  constexpr double kJump = 1e-6;  // of L: sqrt(kCollinear) = 1e-7, times a factor of order 1
  for (const double thickness : {0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4, 1e-2, 1.0}) {
    Matrix3X<double> positions(3, 3);
    positions << -1, 0, 1, 0, thickness, 0, 0, 0, 0;
    const ClothMesh mesh = small_mesh(positions, Edges(2, 0));
    const Matrix3X<double> before = rigid_motion(mesh, {0.3, -0.7, 0.5}, {0, 0, 0});
    const Vector3<double> expected =
        std::exp(-kRotationDampingRate * kRotationDampingTimeStep) * spin_momentum(mesh, before);
    const Matrix3X<double> after =
        advanced(kRotationDampingLaw, mesh, before, kRotationDampingTimeStep);
    EXPECT_LT((spin_momentum(mesh, after) - expected).norm(), kJump * expected.norm())
        << "thickness " << thickness;
  }
}

TEST(RotationDamping, ASingleNodeFeelsNothing) {
  const ClothMesh mesh = small_mesh(Matrix3X<double>::Ones(3, 1), Edges(2, 0));
  const Matrix3X<double> before = arbitrary(1, 1);
  EXPECT_EQ(advanced(kRotationDampingLaw, mesh, before, kRotationDampingTimeStep), before);
}

TEST(RotationDamping, PinnedNodesAreLeftOut) {
  ClothMesh mesh = lopsided_body();
  ClothMesh rest = mesh;  // the body without its first node
  rest.rest_positions = mesh.rest_positions.rightCols(6).eval();
  rest.masses = mesh.masses.tail(6).eval();
  mesh.pinned = {0};
  const Matrix3X<double> before = arbitrary(7, 1);
  const Matrix3X<double> after =
      advanced(kRotationDampingLaw, mesh, before, kRotationDampingTimeStep);
  EXPECT_EQ(after.col(0), before.col(0));
  EXPECT_EQ(after.rightCols(6),
            advanced(kRotationDampingLaw, rest, before.rightCols(6), kRotationDampingTimeStep));
  EXPECT_TRUE(forces_on(kRotationDampingLaw, mesh, mesh.rest_positions, before).col(0).isZero(0));
}

TEST(RotationDamping, TheStateOfAnotherMeshIsRefused) {
  const auto law = make_law<double>(kRotationDampingLaw, lopsided_body());
  const ClothMesh other = one_spring(1.0);
  const Matrix3X<double> velocities = Matrix3X<double>::Zero(3, 2);
  Matrix3X<double> result = velocities;
  EXPECT_THROW(
      law->advance_velocities({other.rest_positions, velocities, other.masses}, 0.1, result),
      InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
