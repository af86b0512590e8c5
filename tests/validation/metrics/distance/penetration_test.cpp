#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/distance/penetration.hpp>
#include <weft/validation/metrics/distance/signed_distance.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

using scenes::BoxShape;
using scenes::PlaneShape;
using scenes::SphereShape;

/// One cloth of 5 x 5 nodes, 2 m x 2 m, margin 5 cm, flat at the given height; the colliders stand
/// as in the scene.
struct Fixture {
  scenes::Scene scene;
  scenes::SceneState state;

  Fixture(std::vector<scenes::Collider> colliders, double height) {
    scenes::Cloth cloth;
    cloth.name = "cloth";
    cloth.grid().nodes = {5, 5};
    cloth.grid().size = {2.0, 2.0};
    cloth.collision_margin = 0.05;
    scene.cloths = {cloth};
    scene.colliders = std::move(colliders);
    const Matrix3X<double> positions = flat_cloth(5, 2.0, height).rest_positions;
    state.cloths.push_back({"cloth", positions, Matrix3X<double>::Zero(3, positions.cols())});
    for (const scenes::Collider& c : scene.colliders) {
      scenes::RigidState rigid;
      rigid.name = c.name;
      rigid.position = c.position;
      rigid.orientation = c.orientation;
      state.rigids.push_back(rigid);
    }
  }
};

scenes::Collider collider(const scenes::Shape& shape) {
  scenes::Collider result{.name = "collider", .shape = shape, .mass = std::nullopt};
  return result;
}

TEST(SignedDistance, OfASphere) {
  const Pose pose{{1, 0, 0}, Eigen::Quaterniond::Identity()};
  EXPECT_EQ(signed_distance(SphereShape{2.0}, pose, {1, 5, 0}), 3.0);
  EXPECT_EQ(signed_distance(SphereShape{2.0}, pose, {1, 0, 0}), -2.0);
}

TEST(SignedDistance, OfABoxAtFaceEdgeCornerAndInside) {
  const BoxShape box{{1, 2, 3}};
  const Pose pose;
  EXPECT_NEAR(signed_distance(box, pose, {1.5, 0, 0}), 0.5, kRoundoff);
  EXPECT_NEAR(signed_distance(box, pose, {4, 6, 0}), 5.0, kRoundoff);
  EXPECT_NEAR(signed_distance(box, pose, {-2, -4, -5}), 3.0, kRoundoff);
  EXPECT_NEAR(signed_distance(box, pose, {0, 0, 0}), -1.0, kRoundoff);
  EXPECT_NEAR(signed_distance(box, pose, {0.5, 1.9, 0}), -0.1, kRoundoff);
  EXPECT_NEAR(signed_distance(box, pose, {1, 2, 3}), 0.0, kRoundoff);
}

TEST(SignedDistance, FollowsTheOrientation) {
  const Eigen::Quaterniond quarter(
      Eigen::AngleAxisd(std::numbers::pi / 4, Vector3<double>::UnitZ()));
  const BoxShape box{{1, 1, 1}};
  EXPECT_NEAR(signed_distance(box, {{0, 0, 0}, quarter}, {0, 2, 0}), 2 - std::sqrt(2.0), kRoundoff);
  const Vector3<double> normal = quarter * Vector3<double>::UnitY();
  EXPECT_NEAR(
      signed_distance(PlaneShape{}, {{1, 1, 0}, quarter}, Vector3<double>(1, 1, 0) - 0.7 * normal),
      -0.7, kRoundoff);
  Eigen::Quaterniond doubled = quarter;
  doubled.coeffs() *= 2.0;
  EXPECT_NEAR(signed_distance(box, {{0, 0, 0}, doubled}, {0, 2, 0}), 2 - std::sqrt(2.0), kRoundoff);
}

TEST(SignedDistance, OfNonFiniteInputIsNaN) {
  Eigen::Quaterniond none(0, 0, 0, 0);
  for (const scenes::Shape& shape :
       {scenes::Shape(SphereShape{1}), scenes::Shape(BoxShape{{1, 1, 1}}),
        scenes::Shape(PlaneShape{})}) {
    EXPECT_TRUE(std::isnan(signed_distance(shape, {}, {kNaN, 0, 0})));
    EXPECT_TRUE(std::isnan(signed_distance(shape, {}, {0, 0, kInfinity})));
    EXPECT_TRUE(std::isnan(signed_distance(shape, {{0, kNaN, 0}, {}}, {0, 0, 0})));
    EXPECT_TRUE(std::isnan(signed_distance(shape, {{0, 0, 0}, none}, {0, 0, 0})));
  }
}

TEST(Penetration, OfAClothSunkIntoAPlane) {
  const Fixture f({collider(PlaneShape{})}, -0.02);
  const Penetration p = penetrations(f.scene, f.state).at(0);
  EXPECT_EQ(p.cloth, "cloth");
  EXPECT_EQ(p.collider, "collider");
  EXPECT_NEAR(p.closest, -0.02, kRoundoff);
  EXPECT_NEAR(p.surface.deepest, 0.02, kRoundoff);
  EXPECT_NEAR(p.surface.percentile_99, 0.02, kRoundoff);
  EXPECT_EQ(p.surface.num_inside, 25);
  EXPECT_NEAR(p.margin.deepest, 0.07, kRoundoff);
}

TEST(Penetration, SeparatesSurfaceAndMargin) {
  const Fixture f({collider(PlaneShape{})}, 0.03);
  const Penetration p = penetrations(f.scene, f.state).at(0);
  EXPECT_EQ(p.surface.deepest, 0.0);
  EXPECT_EQ(p.surface.num_inside, 0);
  EXPECT_NEAR(p.margin.deepest, 0.02, kRoundoff);
  EXPECT_EQ(p.margin.num_inside, 25);
}

TEST(Penetration, OfASphereFindsTheDeepestNode) {
  // Nodes at spacing 0.5 in the plane y = 0; the sphere holds the centre node and its four
  // neighbors.
  const Fixture f({collider(SphereShape{0.6})}, 0.0);
  const Penetration p = penetrations(f.scene, f.state).at(0);
  EXPECT_EQ(p.closest_node, 12);
  EXPECT_NEAR(p.surface.deepest, 0.6, kRoundoff);
  EXPECT_EQ(p.surface.num_inside, 5);
  // Rank 0.99 * 24 = 23.76 between the depths 0.1 and 0.6.
  EXPECT_NEAR(p.surface.percentile_99, 0.1 + 0.76 * 0.5, kRoundoff);
}

TEST(Penetration, OfABoxIsTheWayToItsNearestFace) {
  scenes::Collider box = collider(BoxShape{{0.7, 0.2, 0.7}});
  box.position = {0, 0.05, 0};
  const Fixture f({box}, 0.0);
  const Penetration p = penetrations(f.scene, f.state).at(0);
  EXPECT_EQ(p.surface.num_inside, 9);
  EXPECT_NEAR(p.surface.deepest, 0.15, kRoundoff);  // down: 0.2 - 0.05
}

TEST(Penetration, CollidersStandWhereTheStateSays) {
  Fixture f({collider(PlaneShape{}), collider(SphereShape{0.3})}, 0.0);
  f.state.rigids[0].position.y() = -1.0;
  f.state.rigids[1].position = {1.0, 0.4, 1.0};
  const std::vector<Penetration> rows = penetrations(f.scene, f.state);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[0].closest, 1.0, kRoundoff);
  EXPECT_NEAR(rows[1].closest, 0.1, kRoundoff);
  const Vector3<double> nearest = f.state.cloths[0].positions.col(rows[1].closest_node);
  EXPECT_LT((nearest - Vector3<double>(1, 0, 1)).norm(), kRoundoff);
}

TEST(Penetration, NonFiniteNodesAreNamedAndNeverSmall) {
  Fixture f({collider(PlaneShape{})}, 1.0);
  f.state.cloths[0].positions(0, 7) = kNaN;
  const Penetration p = penetrations(f.scene, f.state).at(0);
  EXPECT_EQ(p.first_non_finite_node, 7);
  EXPECT_EQ(p.closest_node, 7);
  for (const double value : {p.closest, p.surface.deepest, p.surface.percentile_99,
                             p.margin.deepest, p.margin.percentile_99}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(Penetration, RefusesStatesOfOtherScenes) {
  Fixture f({collider(PlaneShape{})}, 1.0);
  Fixture fewer_nodes = f;
  fewer_nodes.state.cloths[0].positions.conservativeResize(3, 24);
  EXPECT_THROW((void)penetrations(fewer_nodes.scene, fewer_nodes.state), InvalidArgument);
  f.state.rigids.clear();
  EXPECT_THROW((void)penetrations(f.scene, f.state), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
