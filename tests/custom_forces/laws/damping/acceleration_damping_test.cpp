#include <weft/custom_forces/laws/damping/acceleration_damping.hpp>

#include <gtest/gtest.h>
#include <weft/core/error.hpp>

#include "tests/custom_forces/small_bodies.hpp"

namespace weft::forces {
namespace {

LawSpecification law_of(double beta) {
  return {.law = "acceleration_damping", .sets = {}, .parameters = {{"beta", {beta}}}};
}

Matrix3X<double> redistributed(double beta, const ClothMesh& mesh, Matrix3X<double> forces) {
  const auto law = make_law<double>(law_of(beta), mesh);
  const Matrix3X<double> velocities = Matrix3X<double>::Zero(3, mesh.num_nodes());
  law->redistribute_forces({mesh.rest_positions, velocities, mesh.masses}, forces);
  return forces;
}

TEST(AccelerationDamping, DividesAccelerationsRelativeToTheCentreOfMass) {
  ClothMesh mesh = one_spring(1.0);
  mesh.masses << 1.0, 3.0;
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, 2);
  forces.row(1) << 6.0, 6.0;  // accelerations 6 and 2, of the centre 3 m/s^2
  const Matrix3X<double> result = redistributed(2.0, mesh, forces);
  EXPECT_NEAR(result(1, 0), 1.0 * (3.0 + 3.0 / 3), 12 * kRoundoff);
  EXPECT_NEAR(result(1, 1), 3.0 * (3.0 - 1.0 / 3), 12 * kRoundoff);
}

TEST(AccelerationDamping, OfZeroChangesNoBit) {
  const Matrix3X<double> forces = arbitrary(7, 3);
  EXPECT_EQ(redistributed(0.0, lopsided_body(), forces), forces);
}

TEST(AccelerationDamping, PinnedNodesAreLeftOut) {
  ClothMesh mesh = lopsided_body();
  mesh.pinned = {2};
  const Matrix3X<double> forces = arbitrary(7, 3);
  Matrix3X<double> other = forces;
  other.col(2) *= 100.0;
  const Matrix3X<double> result = redistributed(1.5, mesh, other);
  EXPECT_EQ(result.col(2), other.col(2));
  EXPECT_EQ(result.rightCols(4), redistributed(1.5, mesh, forces).rightCols(4));
}

TEST(AccelerationDamping, ABodyOfPinnedNodesIsLeftAlone) {
  ClothMesh mesh = one_spring(1.0);
  mesh.pinned = {0, 1};
  const Matrix3X<double> forces = arbitrary(2, 3);
  EXPECT_EQ(redistributed(1.5, mesh, forces), forces);
}

TEST(AccelerationDamping, ABodyInBalanceStaysInBalance) {
  // The operator is regular: where free nodes feel no force before, they feel none after, and only
  // there. So the static shape is the same.
  ClothMesh mesh = lopsided_body();
  mesh.pinned = {0, 1};
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, 7);
  forces.leftCols(2) = arbitrary(2, 3);
  EXPECT_EQ(redistributed(4.0, mesh, forces), forces);
}

TEST(AccelerationDamping, TheStateOfAnotherMeshIsRefused) {
  const auto law = make_law<double>(law_of(1.0), lopsided_body());
  const ClothMesh other = one_spring(1.0);
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, 2);
  const Matrix3X<double> velocities = forces;
  const State<double> state{other.rest_positions, velocities, other.masses};
  EXPECT_THROW(law->redistribute_forces(state, forces), InvalidArgument);
  EXPECT_THROW((void)law->added_kinetic_energy(state), InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
