#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/paint/pattern.hpp>
#include <weft/playback/rendering/renderer.hpp>

#include "tests/playback/rendering/small_scene.hpp"

namespace weft::scenes {
namespace {

/// As in renderer_test.cpp: surely a different thing and not a gradient.
constexpr int kAppearanceRenderOtherThing = 12;

struct AppearanceRenderTest : testing::Test {
  Scene scene = small_scene();
  RenderOptions options = small_options();

  Image picture() { return Renderer(scene).render(rest_state(scene), options); }
  /// The pixel that shows the place of the cloth with these texture coordinates.
  Rgb cloth_pixel(const Image& image, double u, double v) const {
    const ClothGrid& grid = scene.cloths[0].grid();
    return pixel_at(image, scene.camera,
                    grid.center + (u - 0.5) * grid.size[0] * grid.u_axis +
                        (v - 0.5) * grid.size[1] * grid.v_axis);
  }
};

bool is_red(const Rgb& color) {
  return color[0] > color[2] + kAppearanceRenderOtherThing;
}
bool is_blue(const Rgb& color) {
  return color[2] > color[0] + kAppearanceRenderOtherThing;
}

TEST_F(AppearanceRenderTest, ColoursOfASceneReplaceThePalette) {
  scene.cloths[0].appearance.color = Rgb{200, 20, 20};
  scene.colliders[0].appearance.color = Rgb{20, 20, 200};
  const Image image = picture();
  EXPECT_TRUE(is_red(cloth_pixel(image, 0.53, 0.53)));
  EXPECT_TRUE(is_blue(pixel_at(image, scene.camera, scene.colliders[0].position)));
}

TEST_F(AppearanceRenderTest, ChecksLieWhereTheCoordinatesSay) {
  Appearance& cloth = scene.cloths[0].appearance;
  cloth.color = Rgb{200, 20, 20};
  cloth.pattern_color = Rgb{20, 20, 200};
  cloth.pattern = Pattern::kChecks;
  cloth.texture_repeat = {0.5, 0.25};  // 4 x 2 checks
  scene.camera.position = {0, 12, 3};
  options.width = 640;
  options.height = 360;
  const Image image = picture();
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 4; ++i) {
      const Rgb seen = cloth_pixel(image, (i + 0.5) / 4, (j + 0.5) / 2);
      EXPECT_TRUE((i + j) % 2 == 0 ? is_red(seen) : is_blue(seen)) << i << ' ' << j;
    }
  }
}

TEST_F(AppearanceRenderTest, PictureLiesWithItsFirstRowAtTheFarEndOfV) {
  // 2 x 2 pixels: red, blue / blue, blue.
  const Image small{2, 2, {255, 0, 0, 0, 0, 255, 0, 0, 255, 0, 0, 255}};
  scene.files.push_back({"a.png", encode_png(small)});
  scene.cloths[0].appearance.image = "a.png";
  scene.camera.position = {0, 12, 3};
  const Image image = picture();
  EXPECT_TRUE(is_red(cloth_pixel(image, 0.25, 0.75)));
  EXPECT_TRUE(is_blue(cloth_pixel(image, 0.75, 0.75)));
  EXPECT_TRUE(is_blue(cloth_pixel(image, 0.25, 0.25)));
}

TEST_F(AppearanceRenderTest, PictureThatTheSceneDoesNotHaveIsRefused) {
  scene.cloths[0].appearance.image = "a.png";
  EXPECT_THAT([&] { (void)picture(); },
              testing::ThrowsMessage<InvalidArgument>(testing::HasSubstr("texture 'a.png'")));
}

TEST_F(AppearanceRenderTest, EyeballLooksAlongItsOwnAxis) {
  Collider& ball = scene.colliders[0];
  ball.appearance.pattern = Pattern::kEyeball;
  ball.appearance.color = Rgb{20, 60, 200};
  const Vector3<double> to_eye = scene.camera.position - ball.position;
  ball.orientation = Eigen::Quaterniond::FromTwoVectors(Vector3<double>::UnitZ(), to_eye);
  const Rgb pupil = pixel_at(picture(), scene.camera, ball.position);
  ball.orientation = Eigen::Quaterniond::FromTwoVectors(-Vector3<double>::UnitZ(), to_eye);
  const Rgb behind = pixel_at(picture(), scene.camera, ball.position);
  EXPECT_LT(pupil[1], 70);
  EXPECT_GT(behind[1], 120);
}

TEST_F(AppearanceRenderTest, InvisibleBodyLeavesThePictureAsWithoutIt) {
  scene.colliders[0].appearance.visible = false;
  const Image invisible = picture();
  SceneState away = rest_state(scene);
  away.rigids[0].position.setConstant(std::numeric_limits<double>::quiet_NaN());  // not drawn
  scene.colliders[0].appearance.visible = true;
  const Image shown = picture();
  EXPECT_EQ(invisible.rgb, Renderer(scene).render(away, options).rgb);
  EXPECT_NE(invisible.rgb, shown.rgb);
}

TEST_F(AppearanceRenderTest, CameraFollowsABody) {
  scene.camera.follow = "ball";
  options.show_shadow = false;  // that of the cloth would stay behind too
  Renderer renderer(scene);
  const Image before = renderer.render(rest_state(scene), options);
  SceneState moved = rest_state(scene);
  moved.rigids[0].position += Vector3<double>(30, 0, 12);
  const Image after = renderer.render(moved, options);
  // The ball stays where it was; the cloth stays behind.
  const Vector3<double> ball = scene.colliders[0].position;
  EXPECT_LE(difference(pixel_at(before, scene.camera, ball), pixel_at(after, scene.camera, ball)),
            kAppearanceRenderOtherThing);
  EXPECT_GT(difference(cloth_pixel(before, 0.53, 0.53), cloth_pixel(after, 0.53, 0.53)),
            kAppearanceRenderOtherThing);
}

TEST_F(AppearanceRenderTest, FlatTrianglesHaveEachOneShade) {
  ClothMesh mesh = make_mesh(scene.cloths[0]);
  SceneState state = rest_state(scene);
  for (int i = 0; i < 81; ++i) state.cloths[0].positions(1, i) += 0.3 * ((i % 9) % 2);
  const Image smooth = Renderer(scene).render(state, options);
  scene.cloths[0].appearance.smooth = false;
  const Image flat = Renderer(scene).render(state, options);
  EXPECT_NE(smooth.rgb, flat.rgb);
}

TEST(Pattern, ChecksAreHalfOfEachColour) {
  const Image image = pattern_image(Pattern::kChecks, {{255, 0, 0}, {0, 0, 255}}, 64);
  int red = 0;
  int blue = 0;
  for (int i = 0; i < 64 * 64; ++i) {
    const Rgb color = pixel(image, i % 64, i / 64);
    red += color == Rgb{255, 0, 0} ? 1 : 0;
    blue += color == Rgb{0, 0, 255} ? 1 : 0;
  }
  EXPECT_EQ(red, 64 * 64 / 2);
  EXPECT_EQ(blue, 64 * 64 / 2);
}

TEST(Pattern, ContinuesAcrossItsBorders) {
  // Where a pattern repeats, its first column follows its last: they are as alike as neighbors
  // inside of it. The carpet has a border of its own and the eyeball is no repetition.
  constexpr int kSize = 128;
  for (const Pattern pattern : {Pattern::kStripes, Pattern::kDots, Pattern::kTartan}) {
    const Image image = pattern_image(pattern, {{160, 20, 20}, {240, 230, 210}}, kSize);
    const auto step = [&](int a, int b) {
      double sum = 0.0;
      for (int row = 0; row < kSize; ++row) {
        sum += difference(pixel(image, a, row), pixel(image, b, row));
      }
      return sum;
    };
    double largest = 0.0;
    for (int column = 1; column < kSize; ++column) {
      largest = std::max(largest, step(column - 1, column));
    }
    EXPECT_LE(step(kSize - 1, 0), largest) << static_cast<int>(pattern);
  }
}

}  // namespace
}  // namespace weft::scenes
