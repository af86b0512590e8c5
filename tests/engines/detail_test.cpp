// A character changes its level of detail while it walks: nothing jumps.
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/controllers/detail.hpp>

namespace weft::scenes {
namespace {

constexpr double kSecond = 1.0;

/// The figure of 1.8 m with its cape, without what is drawn only.
Scene caped_figure() {
  Scene scene = load_scene("caped_figure");
  scene.cloths.resize(1);
  scene.characters[0].skins.clear();
  return scene;
}

Detail all_levels(double blend) {
  return {.cloth = "cape",
          .levels = {{0.3, DetailLevel::kSimplified},
                     {0.6, DetailLevel::kSkin},
                     {0.9, DetailLevel::kSimplified},
                     {1.2, DetailLevel::kFull},
                     {1.5, DetailLevel::kSkin},
                     {1.8, DetailLevel::kFull}},
          .blend = blend};
}

struct Jumps {
  double at_switches = 0;  ///< [m] of a node beyond the way that its velocity makes in the step
  double elsewhere = 0;    ///< [m] likewise, in all other steps
};

Jumps jumps_of(std::string_view engine, const Scene& scene, const Detail& detail) {
  const auto simulator = find_engine(engine, StoredPrecision::kFloat32)->make();
  simulator->load(scene);
  const double dt = scene.world.time_step;
  Jumps jumps;
  for (int step = 1; step * dt < 2.0 * kSecond; ++step) {
    const ClothState before = simulator->state().cloths[0];
    const StepReport report = simulator->step(dt);
    EXPECT_FALSE(report.blow_up) << report.blow_up->reason;
    if (report.blow_up) break;
    const ClothState& after = simulator->state().cloths[0];
    const Matrix3X<double> rest = after.positions - before.positions - dt * before.velocities;
    const double jump = rest.colwise().norm().maxCoeff();
    bool is_switch = false;
    for (const DetailSwitch& entry : detail.levels) {
      is_switch = is_switch || std::abs(entry.time - step * dt) < 0.5 * dt;
    }
    double& largest = is_switch ? jumps.at_switches : jumps.elsewhere;
    largest = std::max(largest, jump);
  }
  return jumps;
}

class DetailLevels : public testing::TestWithParam<const char*> {};

TEST_P(DetailLevels, ASwitchMovesNoNodeByAMillimetre) {
  Scene scene = caped_figure();
  scene.controllers = {all_levels(0.3)};
  const Jumps jumps = jumps_of(GetParam(), scene, all_levels(0.3));
  EXPECT_LT(jumps.at_switches, 1e-3);
  RecordProperty("jump_at_switches_um", static_cast<int>(1e6 * jumps.at_switches));
  RecordProperty("jump_elsewhere_um", static_cast<int>(1e6 * jumps.elsewhere));
  // A switch without blending is what must be noticed.
  scene.controllers = {all_levels(0.0)};
  EXPECT_GT(jumps_of(GetParam(), scene, all_levels(0.0)).at_switches, 1e-2);
}

TEST_P(DetailLevels, SkinIsWhereTheBonesHaveIt) {
  Scene scene = caped_figure();
  scene.controllers = {
      Detail{.cloth = "cape", .levels = {{0.1, DetailLevel::kSkin}}, .blend = 0.1}};
  const auto simulator = find_engine(GetParam(), StoredPrecision::kFloat32)->make();
  simulator->load(scene);
  for (int step = 1; step <= 250; ++step) (void)simulator->step(scene.world.time_step);
  const SceneState& state = simulator->state();
  const auto& source = std::get<SkinSource>(scene.cloths[0].source);
  // Rounded to single precision, some 2 m from the origin.
  EXPECT_LT((state.cloths[0].positions - skin_positions(source, state.time)).cwiseAbs().maxCoeff(),
            3e-7);
}

INSTANTIATE_TEST_SUITE_P(Bullet, DetailLevels, testing::Values("bullet_soft", "bullet_forces"),
                         [](const auto& info) { return std::string(info.param); });

TEST(DetailOfTheReference, IsFullOnly) {
  Scene scene = load_scene("hang");
  scene.controllers = {
      Detail{.cloth = scene.cloths[0].name, .levels = {{0.0, DetailLevel::kSkin}}}};
  const auto simulator = find_engine("reference", StoredPrecision::kFloat64)->make();
  simulator->load(scene);
  EXPECT_THROW((void)simulator->step(scene.world.time_step), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
