#include <weft/viewer/model/picking.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <weft/playback/rendering/view.hpp>

namespace weft::viewer {
namespace {

constexpr double kAspect = 1.6;

scenes::Camera camera() {
  scenes::Camera camera;
  camera.position = {2.0, 1.5, 4.0};
  camera.target = {0.2, 0.5, 0.0};
  return camera;
}

scenes::SceneState two_sheets() {
  scenes::SceneState state;
  for (const double z : {0.0, 0.5}) {
    scenes::ClothState& cloth = state.cloths.emplace_back();
    cloth.positions.resize(3, 3);
    cloth.positions << 0.0, 0.3, 0.6, 0.5, 0.5, 0.5, z, z, z;
  }
  return state;
}

TEST(Picking, ProjectsAsTheRendererDoes) {
  const Vector3<double> point(0.4, 0.9, 0.3);
  const auto place = project(camera(), kAspect, point);
  ASSERT_TRUE(place);
  const scenes::View view = scenes::make_view(camera(), scenes::Stage(), kAspect);
  const Eigen::Vector4f clip = view.clip_from_world * point.cast<float>().homogeneous();
  EXPECT_NEAR(place->x, 0.5 + 0.5 * static_cast<double>(clip.x() / clip.w()), 1e-6);
  EXPECT_NEAR(place->y, 0.5 - 0.5 * static_cast<double>(clip.y() / clip.w()), 1e-6);
}

TEST(Picking, NothingIsSeenBehindTheCamera) {
  EXPECT_FALSE(project(camera(), kAspect, {4.0, 2.5, 8.0}));
}

TEST(Picking, APlaceAndItsDepthGiveThePointBack) {
  const Vector3<double> point(0.4, 0.9, 0.3);
  const auto place = project(camera(), kAspect, point);
  EXPECT_NEAR((point_at(camera(), kAspect, *place, point) - point).norm(), 0.0, 1e-12);
}

TEST(Picking, TakesTheNodeUnderTheMouse) {
  const scenes::SceneState state = two_sheets();
  for (int node = 0; node < 3; ++node) {
    const auto place = project(camera(), kAspect, state.cloths[1].positions.col(node));
    EXPECT_EQ(pick(camera(), kAspect, *place, state, 2), (NodeId{1, node}));
  }
  EXPECT_FALSE(pick(camera(), kAspect, {0.02, 0.02}, state, 2));
}

TEST(Picking, OfNodesBehindOneAnotherTheFrontOneWins) {
  scenes::Camera straight;
  straight.position = {0.0, 0.5, 5.0};
  straight.target = {0.0, 0.5, 0.0};
  EXPECT_EQ(pick(straight, kAspect, {0.5, 0.5}, two_sheets(), 2), (NodeId{1, 0}));
  EXPECT_EQ(pick(straight, kAspect, {0.5, 0.5}, two_sheets(), 1), (NodeId{0, 0}));
}

TEST(Picking, ACameraThatFollowsMovesWithItsBody) {
  scenes::Scene scene;
  scenes::Collider& ball = scene.colliders.emplace_back();
  ball.name = "ball";
  ball.shape = scenes::SphereShape{0.1};
  scenes::SceneState state;
  state.rigids.push_back({"ball", {1.0, 0.0, 2.0}});
  EXPECT_EQ(followed(scene, camera(), state).target, camera().target);
  scene.camera.follow = "ball";
  EXPECT_EQ(followed(scene, camera(), state).target,
            camera().target + Vector3<double>(1.0, 0.0, 2.0));
}

TEST(Picking, FindsTheNearestColliderThatIsDrawn) {
  scenes::Scene scene;
  scenes::SceneState state;
  const auto add = [&](scenes::Shape shape, const Vector3<double>& position) {
    scenes::Collider& collider = scene.colliders.emplace_back();
    collider.shape = std::move(shape);
    state.rigids.push_back({collider.name, position});
  };
  add(scenes::SphereShape{0.3}, {0.2, 0.5, 0.0});
  add(scenes::BoxShape{{0.1, 0.1, 0.1}}, {0.65, 0.75, 1.0});  // in front of it
  add(scenes::PlaneShape{}, {0, 0, 0});
  const Place middle{0.5, 0.5};
  auto seen = pick_collider(camera(), kAspect, middle, scene, state);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->collider, 1U);
  scene.colliders[1].appearance.visible = false;
  seen = pick_collider(camera(), kAspect, middle, scene, state);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->collider, 0U);
  // A sphere is drawn with flat triangles.
  EXPECT_NEAR((seen->point - state.rigids[0].position).norm(), 0.3, 0.01);
  EXPECT_LT((seen->point - camera().position).norm(),
            (state.rigids[0].position - camera().position).norm());
  EXPECT_FALSE(pick_collider(camera(), kAspect, {0.5, 0.95}, scene, state)) << "the ground";
}

}  // namespace
}  // namespace weft::viewer
