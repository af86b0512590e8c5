#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <weft/core/error.hpp>

#include "tests/playback/rendering/small_scene.hpp"

namespace weft::scenes {
namespace {

/// Round-off of a quotient of lengths of size 1: some units in the last place.
constexpr double kRoundOff = 16 * std::numeric_limits<double>::epsilon();

TEST(NodeStrain, IsZeroAtRest) {
  const ClothMesh mesh = make_mesh(small_scene().cloths[0]);
  EXPECT_LE(node_strain(mesh, mesh.rest_positions).cwiseAbs().maxCoeff(), kRoundOff);
}

TEST(NodeStrain, KeepsTheSignOfTheLargestChange) {
  const ClothMesh mesh = make_mesh(small_scene().cloths[0]);
  Matrix3X<double> positions = mesh.rest_positions;
  positions.row(0) *= 1.1;
  positions.row(2) *= 0.7;
  const Eigen::VectorXd strain = node_strain(mesh, positions);
  for (Eigen::Index i = 0; i < strain.size(); ++i) EXPECT_NEAR(strain[i], -0.3, kRoundOff);
}

TEST(NodeStrain, ShowsWhereThePositionsAreNotFinite) {
  const ClothMesh mesh = make_mesh(small_scene().cloths[0]);
  Matrix3X<double> positions = mesh.rest_positions;
  positions(1, 0) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd strain = node_strain(mesh, positions);
  EXPECT_TRUE(std::isnan(strain[0]));
  EXPECT_TRUE(std::isnan(strain[1]));  // its neighbor shares a spring
  EXPECT_LE(std::abs(strain[80]), kRoundOff);
}

TEST(NodeStrain, IsZeroOfABodyWithoutSprings) {
  ClothMesh mesh = make_mesh(small_scene().cloths[0]);
  mesh.edge_sets.clear();
  EXPECT_TRUE(node_strain(mesh, 2.0 * mesh.rest_positions).isZero(0.0));
}

TEST(NodeStrain, RefusesPositionsOfAnotherMesh) {
  const ClothMesh mesh = make_mesh(small_scene().cloths[0]);
  EXPECT_THROW((void)node_strain(mesh, Matrix3X<double>::Zero(3, 4)), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
