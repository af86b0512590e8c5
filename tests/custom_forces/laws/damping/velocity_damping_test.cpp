#include <weft/custom_forces/laws/damping/velocity_damping.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kRate = 0.8;  // [1/s]
const LawSpecification kLaw{
    .law = "velocity_damping", .sets = {}, .parameters = {{"rate", {kRate}}}};

Matrix3X<double> after(double duration, int num_steps) {
  const ClothMesh mesh = one_spring(1.0);
  const auto law = make_law<double>(kLaw, mesh);
  Matrix3X<double> velocities = Matrix3X<double>::Constant(3, 2, 2.0);
  for (int step = 0; step < num_steps; ++step) {
    const Matrix3X<double> before = velocities;
    law->advance_velocities({mesh.rest_positions, before, mesh.masses}, duration / num_steps,
                            velocities);
  }
  return velocities;
}

TEST(VelocityDamping, DecaysExponentially) {
  EXPECT_NEAR(after(1.5, 1)(1, 1), 2.0 * std::exp(-1.2), 2.0 * kRoundoff);
}

TEST(VelocityDamping, DoesNotDependOnTheTimeStep) {
  for (const int num_steps : {2, 10, 1000}) {
    EXPECT_NEAR(after(1.5, num_steps)(0, 0), after(1.5, 1)(0, 0), 2.0 * num_steps * kRoundoff);
  }
}

TEST(VelocityDamping, NeverReversesAVelocityHoweverLongTheStep) {
  EXPECT_GT(after(100.0, 1).minCoeff(), 0.0);
}

TEST(VelocityDamping, ForceIsRateTimesMomentum) {
  ClothMesh mesh = one_spring(1.0);
  mesh.masses << 1.0, 5.0;
  const Matrix3X<double> velocities = Matrix3X<double>::Constant(3, 2, 2.0);
  const Matrix3X<double> force = forces_on(kLaw, mesh, mesh.rest_positions, velocities);
  EXPECT_NEAR(force(0, 0), -1.6, 1.6 * kRoundoff);
  EXPECT_NEAR(force(2, 1), -8.0, 8.0 * kRoundoff);
}

}  // namespace
}  // namespace weft::forces
