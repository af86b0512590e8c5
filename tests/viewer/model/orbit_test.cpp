#include <weft/viewer/model/orbit.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace weft::viewer {
namespace {

constexpr double kTolerance = 1e-12;

scenes::Camera orbit_camera() {
  scenes::Camera camera;
  camera.position = {1.0, 2.0, 5.0};
  camera.target = {1.0, 2.0, 1.0};
  camera.field_of_view = 0.5;
  return camera;
}

double distance(const scenes::Camera& camera) {
  return (camera.position - camera.target).norm();
}

TEST(Orbit, AQuarterTurnGoesRound) {
  scenes::Camera moved = orbit_camera();
  rotate(moved, M_PI / 2, 0.0);
  EXPECT_NEAR((moved.position - Vector3<double>(5.0, 2.0, 1.0)).norm(), 0.0, kTolerance);
  EXPECT_EQ(moved.target, orbit_camera().target);
}

TEST(Orbit, TurningUpwardsEndsBelowTheZenith) {
  scenes::Camera moved = orbit_camera();
  rotate(moved, 0.0, 0.3);
  EXPECT_NEAR(moved.position.y() - 2.0, 4.0 * std::sin(0.3), kTolerance);
  for (int i = 0; i < 100; ++i) rotate(moved, 0.0, 0.3);
  EXPECT_NEAR(distance(moved), 4.0, 1e-9);
  EXPECT_LT(moved.position.y(), 6.0);
  EXPECT_GT(moved.position.z(), moved.target.z());
}

TEST(Orbit, ZoomChangesTheDistanceWithinBounds) {
  scenes::Camera moved = orbit_camera();
  zoom(moved, 2.0);
  EXPECT_NEAR(distance(moved), 2.0, kTolerance);
  for (int i = 0; i < 100; ++i) zoom(moved, 2.0);
  EXPECT_NEAR(distance(moved), 1e-3, kTolerance);
  for (int i = 0; i < 100; ++i) zoom(moved, 0.5);
  EXPECT_NEAR(distance(moved), 1e5, 1e-6);
}

TEST(Orbit, PanMovesBothByTheHeightOfThePicture) {
  scenes::Camera moved = orbit_camera();
  pan(moved, 0.0, 1.0);
  const double height = 2.0 * std::tan(0.25) * 4.0;
  EXPECT_NEAR((moved.target - orbit_camera().target - Vector3<double>(0, height, 0)).norm(), 0.0,
              kTolerance);
  EXPECT_NEAR(distance(moved), 4.0, kTolerance);
  pan(moved, 1.0, -1.0);
  EXPECT_NEAR((moved.target - orbit_camera().target - Vector3<double>(height, 0, 0)).norm(), 0.0,
              kTolerance);
}

}  // namespace
}  // namespace weft::viewer
