#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/scenes/characters/character_controller.hpp>
#include <weft/validation/metrics/distance/penetration.hpp>

#include "tests/scenes/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

/// The length of a run [s]: each leg and each arm swings back into the cape once.
constexpr double kDuration = 1.0;
/// A little more than one round of the clip [s], so that its seam is in it.
constexpr double kClipDuration = 2.2;
/// Three roundings to single precision of places some 2 m from the origin [m].
constexpr double kRounding = 6.0 * static_cast<double>(std::numeric_limits<float>::epsilon());

/// The worst of all frames of a run.
struct CapeNumbers {
  double attachment = 0;  ///< [m] of an attached node from where the bones have it
  double reach = -1;      ///< [m] beyond the maximum distance
  double speed = 0;       ///< [m/s] of a node relative to its place on the skin
  double closest = 1;     ///< [m] from a node to a collider that a bone leads
  double swing = 0;       ///< [m] of a node from its place on the skin
  int looked = 0;
};

/// Velocities of the skin at a time, by central differences over a step of the scene [m/s].
Matrix3X<double> skin_velocities(const SkinSource& source, double time, double time_step) {
  const double half = 0.5 * time_step;
  return (skin_positions(source, time + half) - skin_positions(source, time - half)) / time_step;
}

class CapedFigure : public testing::TestWithParam<const char*> {
 protected:
  static Scene scene() {
    Scene scene = load_scene("caped_figure");
    scene.engines = {GetParam()};
    scene.cloths.resize(1);  // without the skin, which is drawn only
    scene.characters[0].skins.clear();
    scene.world.duration = kDuration;
    scene.world.frame_interval = 10 * scene.world.time_step;
    return scene;
  }
};

CapeNumbers measure(const Scene& scene) {
  const auto& source = std::get<SkinSource>(scene.cloths[0].source);
  const std::vector<int> pinned = make_mesh(scene.cloths[0]).pinned;
  const VectorX<double> distances = max_distances(scene.characters[0].cloths[0].reach, source);
  CapeNumbers worst;
  run_scene(scene, [&](const SceneState& state) {
    const ClothState& cape = state.cloths[0];
    const Matrix3X<double> skin = skin_positions(source, state.time);
    const Matrix3X<double> stored = skin.cast<float>().cast<double>();
    for (const int node : pinned) {
      const Vector3<double> lag = cape.positions.col(node) - stored.col(node);
      worst.attachment = std::max(worst.attachment, lag.cwiseAbs().maxCoeff());
    }
    const VectorX<double> away = (cape.positions - skin).colwise().norm().transpose();
    worst.reach = std::max(worst.reach, (away - distances).maxCoeff());
    worst.swing = std::max(worst.swing, away.maxCoeff());
    const Matrix3X<double> own =
        cape.velocities - skin_velocities(source, state.time, scene.world.time_step);
    worst.speed = std::max(worst.speed, own.colwise().norm().maxCoeff());
    const auto rows = validation::penetrations(scene, state);
    for (std::size_t r = 0; r < scene.colliders.size(); ++r) {
      if (!scene.colliders[r].led_by.empty())
        worst.closest = std::min(worst.closest, rows[r].closest);
    }
    ++worst.looked;
  });
  return worst;
}

TEST_P(CapedFigure, ItsCapeFollowsTheShouldersFlowsAndStaysOutOfTheBody) {
  const CapeNumbers worst = measure(scene());
  EXPECT_EQ(worst.looked, 100);
  EXPECT_EQ(worst.attachment, 0.0);
  EXPECT_LT(worst.reach, kRounding);
  // A hand swings at 1.5 m/s, a foot at 3 m/s; a cape that is thrown is faster.
  EXPECT_LT(worst.speed, 3.0);
  EXPECT_GT(worst.closest, 0.5 * scene().cloths[0].collision_margin);
  EXPECT_GT(worst.swing, 0.1);
  RecordProperty("speed", std::to_string(worst.speed));
  RecordProperty("closest", std::to_string(worst.closest));
  RecordProperty("swing", std::to_string(worst.swing));
}

INSTANTIATE_TEST_SUITE_P(Bullet, CapedFigure,
                         testing::Values("bullet_soft", "bullet_forces", "bullet_weft"),
                         [](const auto& info) { return std::string(info.param); });

// Exporters may write a quaternion as q at one key and as -q, the same pose, at the next: a spline
// between them turns the limb around within 20 ms, through the cape.
TEST(CapedFigureClip, TurnsNoBoneFasterThanAWalkDoes) {
  const Scene scene = load_scene("caped_figure");
  const CharacterSettings& figure = scene.characters[0];
  const double interval = 1e-3;
  double fastest = 0;
  auto last = world_frames(*figure.model, figure.pose, 0.0);
  for (int i = 1; i * interval < kClipDuration; ++i) {
    const auto now = world_frames(*figure.model, figure.pose, i * interval);
    for (std::size_t bone = 0; bone < now.size(); ++bone) {
      const Eigen::Quaterniond turn(now[bone].rotation() * last[bone].rotation().transpose());
      fastest = std::max(fastest, Eigen::AngleAxisd(turn).angle() / interval);
    }
    last = now;
  }
  EXPECT_GT(fastest, 1.0);   // it walks
  EXPECT_LT(fastest, 10.0);  // [rad/s]; a knee that swings through reaches 5
}

}  // namespace
}  // namespace weft::scenes
