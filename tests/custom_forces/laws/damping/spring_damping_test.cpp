#include <weft/custom_forces/laws/damping/spring_damping.hpp>

#include <gtest/gtest.h>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kDamping = 3.0;  // [N s/m]
const LawSpecification kSpringDampingLaw{
    .law = "spring_damping", .sets = {}, .parameters = {{"damping", {kDamping}}}};

Matrix3X<double> second_node(double x, double y, double z) {
  Matrix3X<double> columns = Matrix3X<double>::Zero(3, 2);
  columns.col(1) << x, y, z;
  return columns;
}

TEST(SpringDamping, ResistsTheRateOfLengthening) {
  const Matrix3X<double> force =
      forces_on(kSpringDampingLaw, one_spring(1.0), second_node(1.5, 0, 0), second_node(2, 0, 0));
  EXPECT_NEAR(force(0, 0), 6.0, 6.0 * kRoundoff);
  EXPECT_NEAR(force(0, 1), -6.0, 6.0 * kRoundoff);
}

TEST(SpringDamping, TakesTheComponentAlongTheSpring) {
  // u = (0.6, 0.8, 0), v . u = 0.6 - 1.6 = -1
  const Matrix3X<double> force =
      forces_on(kSpringDampingLaw, one_spring(1.0), second_node(3, 4, 0), second_node(1, -2, 7));
  const Vector3<double> expected = -kDamping * Vector3<double>(0.6, 0.8, 0);
  EXPECT_LE((force.col(0) - expected).norm(), expected.norm() * kRoundoff);
}

TEST(SpringDamping, AVelocityAcrossTheSpringFeelsNothing) {
  EXPECT_TRUE(
      forces_on(kSpringDampingLaw, one_spring(1.0), second_node(1, 0, 0), second_node(0, 5, -3))
          .isZero(0));
}

TEST(SpringDamping, TakesOutDampingTimesRateSquared) {
  const ClothMesh mesh = one_spring(1.0);
  const Matrix3X<double> positions = second_node(1.5, 0, 0);
  const Matrix3X<double> velocities = second_node(2, 1, 0);
  const auto law = make_law<double>(kSpringDampingLaw, mesh);
  EXPECT_NEAR(law->non_conservative_power({positions, velocities, mesh.masses}), -12.0,
              12.0 * kRoundoff);
}

TEST(SpringDamping, ASpringWithoutDirectionExertsNoForce) {
  const Matrix3X<double> force =
      forces_on(kSpringDampingLaw, one_spring(1.0), second_node(0, 0, 0), second_node(1, 1, 1));
  EXPECT_TRUE(force.isZero(0));
}

}  // namespace
}  // namespace weft::forces
