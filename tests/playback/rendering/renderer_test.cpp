#include <weft/playback/rendering/renderer.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/paint/color_bar.hpp>

#include "tests/playback/rendering/small_scene.hpp"

namespace weft::scenes {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A difference of a channel that is surely a different thing and not a gradient of the backdrop:
/// the backdrop changes by less than 2 per pixel, and the things compared are at most 5 pixels
/// apart.
constexpr int kOtherThing = 12;

struct RendererTest : testing::Test {
  Scene scene = small_scene();
  SceneState state = rest_state(scene);
  RenderOptions options = small_options();
};

TEST_F(RendererTest, PictureIsNotEmpty) {
  const Image image = Renderer(scene).render(state, options);
  ASSERT_EQ(image.width, 320);
  ASSERT_EQ(image.height, 180);
  ASSERT_EQ(image.rgb.size(), 320u * 180u * 3u);
  const std::set<std::uint8_t> values(image.rgb.begin(), image.rgb.end());
  EXPECT_GT(values.size(), 32u);
}

TEST_F(RendererTest, SphereIsDrawnWhereTheCameraFormulaPutsIt) {
  Renderer renderer(scene);
  const Image with = renderer.render(state, options);
  SceneState moved = state;
  moved.rigids[0].position.x() = 1e3;
  options.show_shadow = false;
  const Image lit = renderer.render(state, options);
  const Image without = renderer.render(moved, options);
  const Vector3<double> center = scene.colliders[0].position;
  const Eigen::Vector2d place = project(scene.camera, center, 320, 180);
  // Silhouette of a ball: it is seen under asin(r / d), off the axis slightly wider; 2 pixels for
  // that and the edge.
  const double distance = (center - scene.camera.position).norm();
  const double radius = 90.0 / std::tan(0.3) * std::tan(std::asin(0.5 / distance));
  constexpr double kEdge = 2.0;
  for (const double side : {-1.0, 1.0}) {
    const int inside = static_cast<int>(place.x() + side * (radius - kEdge));
    const int outside = static_cast<int>(place.x() + side * (radius + kEdge));
    const int row = static_cast<int>(place.y());
    EXPECT_GE(difference(pixel(lit, inside, row), pixel(without, inside, row)), kOtherThing);
    EXPECT_EQ(pixel(lit, outside, row), pixel(without, outside, row));
  }
  EXPECT_NE(with.rgb, without.rgb);
}

TEST_F(RendererTest, TwoSidesOfClothHaveDifferentColours) {
  Renderer renderer(scene);
  const Vector3<double> middle = scene.cloths[0].grid().center + Vector3<double>(0.1, 0, 0.1);
  const Rgb front = pixel_at(renderer.render(state, options), scene.camera, middle);
  state.cloths[0].positions.row(0) *= -1.0;  // mirrored: the camera sees the other side
  const Rgb back = pixel_at(renderer.render(state, options), scene.camera, middle);
  EXPECT_GT(front[2], front[0] + kOtherThing);  // blue
  EXPECT_GT(back[0], back[2] + kOtherThing);    // orange
}

TEST_F(RendererTest, ShadowDarkensTheGround) {
  Renderer renderer(scene);
  const Image with = renderer.render(state, options);
  options.show_shadow = false;
  const Image without = renderer.render(state, options);
  const Eigen::Vector2d ball = project(scene.camera, scene.colliders[0].position, 320, 180);
  constexpr double kBallRadius = 20.0;  // [pixel], of the silhouette; 14.6 by the formula above
  int num_darker = 0;
  int num_brighter = 0;
  for (int row = 80; row < 180; ++row) {  // below the cloth there is only the ball and the ground
    for (int column = 0; column < 320; ++column) {
      if ((Eigen::Vector2d(column, row) - ball).norm() < kBallRadius) continue;
      const int change = pixel(with, column, row)[1] - pixel(without, column, row)[1];
      if (change < -kOtherThing) ++num_darker;
      if (change > 1) ++num_brighter;
    }
  }
  // The shadow of 4 m^2 at 10 m covers about 1000 pixels; cloth, ball and soft edges take some.
  EXPECT_GT(num_darker, 250);
  EXPECT_EQ(num_brighter, 0);
}

TEST_F(RendererTest, WireframeShowsLinesOverPaper) {
  options.width = 960;
  options.height = 540;
  options.style = SurfaceStyle::kWireframe;
  scene.camera.position = {0, 10, 4};  // from above, where a triangle has 20 pixels
  const Image image = Renderer(scene).render(state, options);
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const Vector3<double> node = mesh.rest_positions.col(4 * 9 + 4);
  const auto triangle = mesh.triangles.col(60);
  const Vector3<double> inside =
      (mesh.rest_positions.col(triangle[0]) + mesh.rest_positions.col(triangle[1]) +
       mesh.rest_positions.col(triangle[2])) /
      3.0;
  const Rgb line = pixel_at(image, scene.camera, node);
  const Rgb paper = pixel_at(image, scene.camera, inside);
  EXPECT_GT(line[2], line[0] + kOtherThing);
  EXPECT_GT(paper[0], line[0] + kOtherThing);
  EXPECT_LT(std::abs(paper[0] - paper[2]), kOtherThing);
}

TEST_F(RendererTest, ScalarColoursFollowTheColourMap) {
  options.style = SurfaceStyle::kScalar;
  options.width = 640;
  options.height = 360;
  Renderer renderer(scene);
  const ColorMap map(2.0, 6.0);
  const ColorBarPlace bar = color_bar_place(640, 360);
  ASSERT_GT(bar.width, 0);
  const Vector3<double> middle = scene.cloths[0].grid().center + Vector3<double>(0.1, 0, 0.1);
  for (const double value : {2.0, 6.0}) {
    const ScalarField field{{Eigen::VectorXd::Constant(81, value)}, 2.0, 6.0, "strain [%]"};
    const Image image = renderer.render(state, options, &field);
    EXPECT_EQ(pixel(image, bar.left + 1, bar.top), map.color(6.0));
    EXPECT_EQ(pixel(image, bar.left + 1, bar.top + bar.height - 1), map.color(2.0));
    // Light scales the colour of the cloth, nearly equally in all channels; 0.1: the lights' own
    // tints.
    const Eigen::Vector3f seen = linear_light(pixel_at(image, scene.camera, middle)).normalized();
    const Eigen::Vector3f expected = linear_light(map.color(value)).normalized();
    EXPECT_LT((seen - expected).norm(), 0.1f) << seen.transpose();
  }
}

TEST_F(RendererTest, ValuesThatAreNotFiniteAreGrey) {
  options.style = SurfaceStyle::kScalar;
  const ScalarField field{
      {Eigen::VectorXd::Constant(81, std::numeric_limits<double>::quiet_NaN())}, 0.0, 0.0, ""};
  const Image image = Renderer(scene).render(state, options, &field);
  const Vector3<double> middle = scene.cloths[0].grid().center + Vector3<double>(0.1, 0, 0.1);
  const Rgb seen = pixel_at(image, scene.camera, middle);
  EXPECT_LT(std::abs(seen[0] - seen[1]) + std::abs(seen[1] - seen[2]), 2 * kOtherThing);
}

TEST_F(RendererTest, AnotherCameraIsAsIfTheSceneHadIt) {
  Renderer renderer(scene);
  const Image home = renderer.render(state, options);
  Scene moved = scene;
  moved.camera.position.x() += 1.0;
  options.camera = moved.camera;
  const Image image = renderer.render(state, options);
  EXPECT_NE(image.rgb, home.rgb);
  options.camera.reset();
  EXPECT_EQ(image.rgb, Renderer(moved).render(state, options).rgb);
}

TEST_F(RendererTest, AGhostLetsThroughItsPartOfTheLight) {
  Renderer renderer(scene);
  const Vector3<double> middle = scene.cloths[0].grid().center + Vector3<double>(0.1, 0, 0.1);
  const auto green_at_middle = [&] {
    return pixel_at(renderer.render(state, options), scene.camera, middle)[1];
  };
  options.show_shadow = false;
  const Image solid = renderer.render(state, options);
  const int of_cloth = green_at_middle();
  options.ghosts = Ghosts{0, scene.colliders.size(), 1.0};
  EXPECT_EQ(renderer.render(state, options).rgb, solid.rgb);
  options.ghosts->first_cloth = scene.cloths.size();
  options.ghosts->opacity = 0.5;
  EXPECT_EQ(renderer.render(state, options).rgb, solid.rgb) << "there is no ghost";
  options.ghosts->first_cloth = 0;
  const int of_ghost = green_at_middle();
  options.ghosts->opacity = 0.01;  // below the first threshold: nothing is left
  const int of_background = green_at_middle();
  EXPECT_GT(of_background, of_cloth + kOtherThing);
  EXPECT_GT(of_ghost, of_cloth + kOtherThing / 2);
  EXPECT_LT(of_ghost, of_background - kOtherThing / 2);
}

TEST_F(RendererTest, MarksAreDrawnInTheirColorAndHiddenByWhatStandsBeforeThem) {
  Renderer renderer(scene);
  Mark mark{
      MarkKind::kPoints, "contact", {220, 0, 0}, Matrix3X<float>(3, 2), Matrix3X<float>(3, 0)};
  const Vector3<double> free(-2.0, 1.0, 0.0);
  const Vector3<double> hidden = scene.colliders[0].position;  // in the middle of the ball
  mark.from.col(0) = free.cast<float>();
  mark.from.col(1) = hidden.cast<float>();
  for (const Vector3<double>& place : {free, hidden}) {
    // Near enough that a point is some pixels wide.
    options.camera = scene.camera;
    options.camera->target = place;
    options.camera->position = place + Vector3<double>(0.0, 0.3, 1.0);
    options.marks.clear();
    const Image plain = renderer.render(state, options);
    options.marks = {mark};
    const Image marked = renderer.render(state, options);
    const Rgb red = pixel_at(marked, *options.camera, place);
    if (place == free) {
      EXPECT_GT(red[0], red[2] + kOtherThing);
    } else {
      EXPECT_EQ(marked.rgb, plain.rgb);
    }
    // What was drawn once is gone with the marks.
    options.marks.clear();
    EXPECT_EQ(renderer.render(state, options).rgb, plain.rgb);
  }
}

TEST_F(RendererTest, SameInputGivesSameBytes) {
  const Image first = Renderer(scene).render(state, options);
  Renderer renderer(scene);
  options.style = SurfaceStyle::kWireframe;
  (void)renderer.render(state, options);  // nothing of another picture may stay behind
  options.style = SurfaceStyle::kShaded;
  const Image second = renderer.render(state, options);
  EXPECT_EQ(encode_png(first), encode_png(second));
}

TEST_F(RendererTest, NumberOfThreadsDoesNotMatter) {
  const Image many = Renderer(scene).render(state, options);
  ASSERT_EQ(setenv("LP_NUM_THREADS", "0", 1), 0);  // read by Mesa's software renderer at its start
  const Image one = Renderer(scene).render(state, options);
  unsetenv("LP_NUM_THREADS");
  EXPECT_EQ(many.rgb, one.rgb);
}

TEST_F(RendererTest, TilesOfLargePicturesFitTogether) {
  // 4 samples give tiles of 512 pixels; 1 sample gives one tile. Where nothing has an edge both
  // show the same.
  options.width = 640;
  options.height = 360;
  options.samples = 4;
  Renderer renderer(scene);
  const Image tiled = renderer.render(state, options);
  options.samples = 1;
  const Image whole = renderer.render(state, options);
  int num_different = 0;
  for (int row = 0; row < 360; ++row) {
    for (int column = 0; column < 640; ++column) {
      if (difference(pixel(tiled, column, row), pixel(whole, column, row)) > kOtherThing) {
        ++num_different;
      }
    }
  }
  EXPECT_LT(num_different, 640 * 360 / 50);  // edges only
}

TEST_F(RendererTest, SurvivesStatesThatAreNotFinite) {
  Renderer renderer(scene);
  const Image good = renderer.render(state, options);
  state.cloths[0].positions(1, 0) = std::numeric_limits<double>::quiet_NaN();
  state.cloths[0].positions(0, 80) = std::numeric_limits<double>::infinity();
  state.cloths[0].positions(2, 8) = 1e300;
  const Image partly = renderer.render(state, options);
  const Vector3<double> middle = scene.cloths[0].grid().center + Vector3<double>(0.1, 0, 0.1);
  EXPECT_LE(
      difference(pixel_at(partly, scene.camera, middle), pixel_at(good, scene.camera, middle)),
      kOtherThing);
  state.cloths[0].positions.setConstant(std::numeric_limits<double>::quiet_NaN());
  state.rigids[0].position.setConstant(std::numeric_limits<double>::quiet_NaN());
  state.rigids[1].orientation.coeffs().setZero();
  EXPECT_EQ(renderer.render(state, options).rgb.size(), good.rgb.size());
}

TEST_F(RendererTest, RefusesWhatDoesNotFitTheScene) {
  Renderer renderer(scene);
  SceneState other = state;
  other.cloths[0].positions.conservativeResize(3, 80);
  EXPECT_THAT([&] { (void)renderer.render(other, options); },
              ThrowsMessage<InvalidArgument>(HasSubstr("cloth 'cloth' = 80, expected 81")));
  other = state;
  other.rigids.pop_back();
  EXPECT_THAT([&] { (void)renderer.render(other, options); },
              ThrowsMessage<InvalidArgument>(HasSubstr("number of colliders = 1, expected 2")));
  options.style = SurfaceStyle::kScalar;
  EXPECT_THAT([&] { (void)renderer.render(state, options); },
              ThrowsMessage<InvalidArgument>(HasSubstr("scalar = none")));
  const ScalarField field{{Eigen::VectorXd::Zero(7)}, 0.0, 1.0, ""};
  EXPECT_THAT([&] { (void)renderer.render(state, options, &field); },
              ThrowsMessage<InvalidArgument>(HasSubstr("scalar values of cloth 0 = 7")));
}

TEST_F(RendererTest, RefusesSizesOutOfRange) {
  Renderer renderer(scene);
  for (const int width : {0, -1, 8193}) {
    options.width = width;
    EXPECT_THAT([&] { (void)renderer.render(state, options); },
                ThrowsMessage<InvalidArgument>(HasSubstr("expected 1 to 8192")));
  }
  options = small_options();
  options.samples = 5;
  EXPECT_THAT([&] { (void)renderer.render(state, options); },
              ThrowsMessage<InvalidArgument>(HasSubstr("samples = 5")));
}

}  // namespace
}  // namespace weft::scenes
