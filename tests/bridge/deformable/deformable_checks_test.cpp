// Bullet's own checks of a Lagrangian force, testDerivative() and testHessian(), run on Weft's. They
// print; the errors they print must fall as their central differences do.

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <weft/bridge/deformable/deformable_world.hpp>

namespace weft::bridge {
namespace {

constexpr double kDeformableChecksEpsilon = std::numeric_limits<btScalar>::epsilon();
constexpr unsigned kSeed = 7;  // Bullet draws its random directions from rand()
constexpr double kDeformableChecksStiffness = 3.0;  // [N/m]

// Bullet moves nodes by 0.1 m and then by 0.5 m and halves of it. In a cloth with springs of 10 m
// that is a small change from the start.
ClothMesh wide_cloth() {
  ClothGrid grid;
  grid.nodes = {5, 5};
  grid.size = {40, 40};
  grid.total_mass = 25;
  return make_cloth_grid(grid);
}

// The numbers behind "error = " in Bullet's output.
std::vector<double> printed_errors(const std::string& output) {
  std::vector<double> errors;
  const std::string mark = "error = ";
  for (std::size_t at = output.find(mark); at != std::string::npos;
       at = output.find(mark, at + 1)) {
    errors.push_back(std::abs(std::strtod(output.c_str() + at + mark.size(), nullptr)));
  }
  return errors;
}

std::vector<double> errors_of(void (btDeformableLagrangianForce::*check)()) {
  const ClothMesh mesh = wide_cloth();
  DeformableWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  world.forces().attach(body, mesh,
                        {{"tension", {}, {{"stiffness", {kDeformableChecksStiffness}}}},
                         {"gravity", {}, {{"acceleration", {0, -9.81, 0}}}}});
  world.solver().reinitialize(world.world().getSoftBodyArray(), btScalar(0.01));  // node numbers
  std::srand(kSeed);
  ::testing::internal::CaptureStdout();
  (world.forces().*check)();
  return printed_errors(::testing::internal::GetCapturedStdout());
}

// A central difference is exact up to the third derivative: halving the step divides its error by 8,
// until what is left is the rounding of the two sums it subtracts.
void expect_third_order(const std::vector<double>& errors, double rounding) {
  ASSERT_EQ(errors.size(), 10U);
  int compared = 0;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    if (errors[i] < 100 * rounding) break;  // 1 % of noise: the order can be seen above it
    const double order = std::log2(errors[i - 1] / errors[i]);
    EXPECT_NEAR(order, 3.0, 0.1) << "halving " << i;  // next term: (0.5 / 10)^2 of the first
    ++compared;
  }
  EXPECT_GE(compared, sizeof(btScalar) == 8 ? 4 : 1);
  for (const double error : errors) EXPECT_LE(error, errors.front() + 100 * rounding);
}

TEST(DeformableChecks, BulletsDerivativeTestSeesThirdOrder) {
  // Stored energy: some hundred springs stretched by half a metre, and 25 kg within half a metre.
  const double energy = 300 * kDeformableChecksStiffness * 0.5 * 0.5 + 25 * 9.81 * 0.5;
  expect_third_order(errors_of(&btDeformableLagrangianForce::testDerivative),
                     energy * kDeformableChecksEpsilon);
}

TEST(DeformableChecks, BulletsHessianTestSeesThirdOrder) {
  // Lengths of 10 m carry the rounding, times the stiffness; 25 nodes with two dozen springs each.
  const double force_rounding =
      kDeformableChecksStiffness * 10 * kDeformableChecksEpsilon * std::sqrt(25.0 * 24.0);
  expect_third_order(errors_of(&btDeformableLagrangianForce::testHessian), force_rounding);
}

}  // namespace
}  // namespace weft::bridge
