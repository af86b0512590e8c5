#include <weft/custom_forces/laws/external/gravity.hpp>

#include <gtest/gtest.h>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

const LawSpecification kGravityLaw{
    .law = "gravity", .sets = {}, .parameters = {{"acceleration", {1.0, -9.0, 0.5}}}};

TEST(Gravity, PullsEveryNodeByItsMass) {
  ClothMesh mesh = one_spring(1.0);
  mesh.masses << 2.0, 0.5;
  const Matrix3X<double> force =
      forces_on(kGravityLaw, mesh, mesh.rest_positions, Matrix3X<double>::Zero(3, 2));
  EXPECT_EQ(Vector3<double>(force.col(0)), Vector3<double>(2, -18, 1));
  EXPECT_EQ(Vector3<double>(force.col(1)), Vector3<double>(0.5, -4.5, 0.25));
}

TEST(Gravity, ActsOnPinnedNodesToo) {
  ClothMesh mesh = one_spring(1.0);
  mesh.pinned = {0};
  const Matrix3X<double> force =
      forces_on(kGravityLaw, mesh, mesh.rest_positions, Matrix3X<double>::Zero(3, 2));
  EXPECT_EQ(force(1, 0), -9.0);
}

TEST(Gravity, EnergyFallsByWeightTimesWay) {
  const ClothMesh mesh = one_spring(1.0);
  const auto law = make_law<double>(kGravityLaw, mesh);
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, 2);
  Matrix3X<double> lower = mesh.rest_positions;
  lower.row(1).array() -= 2.0;
  const double before = law->potential_energy({mesh.rest_positions, still, mesh.masses});
  const double after = law->potential_energy({lower, still, mesh.masses});
  EXPECT_NEAR(before - after, 2 * 9.0 * 2.0, 36 * kRoundoff);
}

}  // namespace
}  // namespace weft::forces
