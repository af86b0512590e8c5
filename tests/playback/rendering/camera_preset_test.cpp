#include <weft/playback/rendering/camera_preset.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/view.hpp>

#include "tests/playback/rendering/small_scene.hpp"

namespace weft::scenes {
namespace {

TEST(CameraPreset, SeesTheWholeSceneInEveryShape) {
  const Scene scene = small_scene();
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  for (const std::string_view name : kCameraPresets) {
    if (name == "scene") continue;
    for (const auto& [width, height] : {std::pair(320, 180), std::pair(90, 200)}) {
      const Camera camera = preset_camera(scene, name, static_cast<double>(width) / height);
      const View view = make_view(camera, make_stage(scene), static_cast<double>(width) / height);
      for (Eigen::Index i = 0; i < mesh.rest_positions.cols(); ++i) {
        const Vector3<double> place = mesh.rest_positions.col(i) - make_stage(scene).center;
        const Eigen::Vector4f clip = view.clip_from_world * place.cast<float>().homogeneous();
        EXPECT_LE(std::abs(clip.x()), clip.w()) << name << " " << width;
        EXPECT_LE(std::abs(clip.y()), clip.w()) << name << " " << width;
      }
    }
  }
}

TEST(CameraPreset, LooksAlongItsAxis) {
  const Scene scene = small_scene();
  const auto axes = [&](std::string_view name) {
    return camera_axes(preset_camera(scene, name, 1.5));
  };
  EXPECT_LT((axes("front") - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((axes("right").col(2) - Vector3<double>::UnitX()).norm(), 1e-12);
  EXPECT_LT((axes("top").col(2) - Vector3<double>::UnitY()).norm(), 1e-12);
  EXPECT_LT((axes("top").col(0) - Vector3<double>::UnitX()).norm(), 1e-12);
  EXPECT_LT((axes("iso").col(2) - Vector3<double>::Ones().normalized()).norm(), 1e-12);
  EXPECT_EQ(preset_camera(scene, "scene", 1.5).position, scene.camera.position);
}

TEST(CameraPreset, RefusesAnotherName) {
  EXPECT_THAT([] { (void)preset_camera(small_scene(), "above", 1.5); },
              testing::ThrowsMessage<InvalidArgument>(
                  testing::HasSubstr("camera 'above', expected one of scene front")));
}

TEST(TurnedCamera, GoesOnceAroundAtItsHeight) {
  const Camera camera = small_scene().camera;
  const Camera half = turned_camera(camera, std::numbers::pi);
  EXPECT_NEAR(half.position.y(), camera.position.y(), 1e-12);
  EXPECT_NEAR((half.position - camera.target).norm(), (camera.position - camera.target).norm(),
              1e-12);
  EXPECT_NEAR(half.position.z(), -camera.position.z(), 1e-12);
  // To the right: from the front to the side where x is largest.
  EXPECT_GT(turned_camera(camera, 0.5 * std::numbers::pi).position.x(), 9.0);
  EXPECT_LT((turned_camera(camera, 2 * std::numbers::pi).position - camera.position).norm(), 1e-12);
}

}  // namespace
}  // namespace weft::scenes
