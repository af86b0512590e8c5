// A run that explodes ends with a report, in every engine: no crash, and nothing that is not finite
// without one.

#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <weft/engines/blow_up_check.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

constexpr double kTimeStep = 1e-3;  // [s], as in all scenes
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class EveryEngine : public testing::TestWithParam<EngineInfo> {
 protected:
  void load(const std::string& text) {
    engine_ = GetParam().make();
    engine_->load(read_scene_text(text, "scene.toml"));
  }
  StepReport step() { return engine_->step(kTimeStep); }
  [[nodiscard]] const SceneState& state() const { return engine_->state(); }

 private:
  std::unique_ptr<Simulator> engine_;
};

std::string spinning_scene(double angular_speed) {
  return fmt::format(R"toml(schema = "weft-scene/1"
name = "spinning"
[world]
time_step = "1 ms"
duration = "1 s"
[[cloth]]
name = "sheet"
grid = {{ nodes = [3, 3], size = ["10 cm", "10 cm"] }}
center = ["0 m", "1 m", "0 m"]
mass = "1 g"
[[cloth.law]]
law = "gravity"
[[collider]]
name = "floor"
shape = "plane"
position = ["0 m", "-1 m", "0 m"]
[[collider]]
name = "top"
shape = "box"
size = ["10 cm", "20 cm", "30 cm"]
mass = "1 kg"
angular_velocity = ["0 rad/s", "{} rad/s", "0 rad/s"]
)toml",
                     angular_speed);
}

TEST_P(EveryEngine, ReportsARigidBodyThatSpinsBeyondAllMeasure) {
  for (const double speed : {2e6, 1e30, 1e200}) {
    load(spinning_scene(speed));
    const StepReport report = step();
    ASSERT_TRUE(report.blow_up) << speed;
    EXPECT_EQ(report.blow_up->body, "top");
    EXPECT_EQ(report.blow_up->step, 1);
    EXPECT_NE(report.blow_up->reason.find("angular"), std::string::npos) << report.blow_up->reason;
    // The step was not taken.
    EXPECT_TRUE(state().rigids[1].position.allFinite());
    EXPECT_TRUE(state().rigids[1].orientation.coeffs().allFinite());
    EXPECT_TRUE(state().cloths[0].positions.allFinite());
    EXPECT_TRUE(step().blow_up);
  }
}

TEST_P(EveryEngine, LetsARigidBodySpinAsFastAsATurbine) {
  load(spinning_scene(1e3));  // the deformable world clamps to a quarter turn per step
  for (int n = 0; n < 20; ++n) {
    const StepReport report = step();
    ASSERT_FALSE(report.blow_up) << report.blow_up->reason;
  }
  EXPECT_NEAR(state().rigids[1].angular_velocity.norm(), 1e3, 1.0);
}

// Beside a block, so that contact is looked for at the place to which the cloth is thrown: 1e9 m away.
constexpr const char* kThrown = R"toml(schema = "weft-scene/1"
name = "thrown"
[world]
time_step = "1 ms"
duration = "1 s"
[[cloth]]
name = "sheet"
grid = { nodes = [4, 4], size = ["10 cm", "10 cm"] }
center = ["0 m", "105 mm", "0 m"]
mass = "1 g"
[[cloth.law]]
law = "gravity"
acceleration = ["3e14 m/s^2", "-1e15 m/s^2", "2e14 m/s^2"]
[[collider]]
name = "block"
shape = "box"
size = ["20 cm", "20 cm", "20 cm"]
)toml";

TEST_P(EveryEngine, FindsAnExplosionBeforeContactLooksAtIt) {
  load(kThrown);
  const StepReport report = step();
  ASSERT_TRUE(report.blow_up);
  EXPECT_EQ(report.blow_up->body, "sheet");
  EXPECT_NE(report.blow_up->reason.find("speed"), std::string::npos) << report.blow_up->reason;
}

// A voxel that follows the grain would give the planet's surface cells beyond what Bullet counts.
constexpr const char* kPlanet = R"toml(schema = "weft-scene/1"
name = "planet"
[world]
time_step = "1 ms"
duration = "1 s"
[[cloth]]
name = "sheet"
grid = { nodes = [4, 4], size = ["10 cm", "10 cm"] }
center = ["0 m", "5 mm", "0 m"]
mass = "1 g"
[[cloth.law]]
law = "gravity"
[[collider]]
name = "planet"
shape = "sphere"
radius = "100 km"
position = ["0 m", "-100 km", "0 m"]
[[collider]]
name = "grain"
shape = "box"
size = ["10 um", "10 um", "10 um"]
position = ["1 m", "1 m", "0 m"]
)toml";

TEST_P(EveryEngine, SurvivesAGrainBesideAPlanet) {
  load(kPlanet);
  for (int n = 0; n < 5; ++n) EXPECT_FALSE(step().blow_up);
  EXPECT_TRUE(state().cloths[0].positions.allFinite());
}

INSTANTIATE_TEST_SUITE_P(Engines, EveryEngine,
                         testing::ValuesIn(engine_table().begin(), engine_table().end()),
                         [](const auto& info) { return std::string(info.param.name); });

SceneState one_of_each() {
  SceneState state;
  state.cloths.push_back({"cloth", Matrix3X<double>::Zero(3, 2), Matrix3X<double>::Zero(3, 2)});
  state.rigids.emplace_back();
  state.rigids[0].name = "rigid";
  return state;
}

TEST(BlowUpCheck, LooksAtEveryNumberOfCloth) {
  EXPECT_FALSE(first_blow_up(one_of_each(), 1, 0.0));
  for (const double bad : {std::nan(""), kInfinity, 2e6}) {
    SceneState state = one_of_each();
    state.cloths[0].velocities(1, 1) = bad;
    const auto found = first_blow_up(state, 7, 0.5);
    ASSERT_TRUE(found) << bad;
    EXPECT_EQ(found->node, 1);
    EXPECT_EQ(found->step, 7);
  }
  SceneState far = one_of_each();
  far.cloths[0].positions(2, 0) = -11.0;
  EXPECT_FALSE(first_blow_up(far, 1, 0.0));
  EXPECT_TRUE(first_blow_up(far, 1, 0.0, 10.0));
}

TEST(BlowUpCheck, LooksAtEveryNumberOfARigidBody) {
  for (int part = 0; part < 4; ++part) {
    for (const double bad : {std::nan(""), kInfinity}) {
      SceneState state = one_of_each();
      RigidState& rigid = state.rigids[0];
      if (part == 0) rigid.position.y() = bad;
      if (part == 1) rigid.orientation.z() = bad;
      if (part == 2) rigid.velocity.x() = bad;
      if (part == 3) rigid.angular_velocity.y() = bad;
      const auto found = first_blow_up(state, 1, 0.0);
      ASSERT_TRUE(found) << part;
      EXPECT_EQ(found->body, "rigid");
    }
  }
}

}  // namespace
}  // namespace weft::scenes
