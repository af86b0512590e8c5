#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <weft/fast_solver/newton/node_stiffness.hpp>

namespace weft::fast {
namespace {

TEST(NodeStiffness, IsThatOfTheBlockAlongADirection) {
  BlockArrays blocks = BlockArrays::Zero(16, 6);
  blocks.row(3) << 4, 5, 6, 1, 2, 3;  // xx, yy, zz, xy, yz, zx
  Matrix3<double> block;
  block << 4, 1, 3, 1, 5, 2, 3, 2, 6;
  const Vector3<double> direction = Vector3<double>(2, -1, 2) / 3;
  EXPECT_NEAR(stiffness_along<double>(blocks, 3, direction), direction.dot(block * direction),
              1e-12);
}

// The energy of a node on a spring that is displaced by a random part of its place's last digit.
TEST(NodeStiffness, RoundingGainsWhatPlacesOffByHalfADigitStore) {
  BlockArrays blocks = BlockArrays::Zero(16, 6);
  blocks.row(2).head<3>().setConstant(1e6F);
  VectorX<float> inertia = VectorX<float>::Zero(16);
  inertia[2] = 1e5F;
  NodeArrays<float> positions = NodeArrays<float>::Zero(16, 3);
  positions(2, 1) = 0.5F;
  const double unit = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
  EXPECT_NEAR(gain_of_rounding<float>({0, 16}, blocks, inertia, positions),
              1.1e6 * unit * unit / 12, 1e-3 * 1.1e6 * unit * unit / 12);
}

}  // namespace
}  // namespace weft::fast
