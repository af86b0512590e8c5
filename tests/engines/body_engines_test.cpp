#include <string>

#include <gtest/gtest.h>

#include <weft/engines/engine_table.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

// Every kind of body that is no grid, falling on a floor: a ball of gas, one with spokes to a centre
// node, a rope. 42 nodes of 100 g on 20 N/m: the fastest mode has about 300 1/s.
constexpr std::string_view kBodies = R"toml(schema = "weft-scene/1"
name = "bodies"
[world]
time_step = "1 ms"
duration = "1 s"
[[cloth]]
name = "balloon"
icosphere = { radius = "20 cm", frequency = 2 }
center = ["0 m", "30 cm", "0 m"]
mass = "100 g"
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "tension"
edge_sets = ["stretch"]
stiffness = "20 N/m"
[[cloth.law]]
law = "pressure"
pressure = "20 Pa"
[[cloth.law]]
law = "hinge_torsion"
rigidity = "1/1000 N*m"
[[cloth]]
name = "ball"
icosphere = { radius = "20 cm", frequency = 2, center_node = true }
center = ["1 m", "30 cm", "0 m"]
mass = "100 g"
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "tension"
edge_sets = ["stretch", "bend", "center"]
stiffness = "20 N/m"
[[cloth]]
name = "rope"
rope = { nodes = 20, start = ["-1 m", "30 cm", "0 m"], end = ["-1 m", "30 cm", "1 m"] }
mass = "50 g"
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "tension"
edge_sets = ["stretch"]
stiffness = "20 N/m"
[[cloth.law]]
law = "torsion"
stiffness = "1/100 N/(m*rad)"
[[collider]]
name = "floor"
shape = "plane"
)toml";

constexpr int kFallSteps = 50;    // the balls start 10 cm above the floor: contact after 140 ms
constexpr int kTotalSteps = 400;  // long enough to land and to be pressed flat and back

class EveryEngine : public testing::TestWithParam<EngineInfo> {
 protected:
  /// Runs num_steps steps from the start.
  SceneState run(const Scene& scene, int num_steps) {
    const std::unique_ptr<Simulator> engine = GetParam().make();
    engine->load(scene);
    for (int i = 0; i < num_steps; ++i) {
      const StepReport report = engine->step(scene.world.time_step);
      EXPECT_FALSE(report.blow_up.has_value()) << report.blow_up->reason;
    }
    return engine->state();
  }
};

TEST_P(EveryEngine, BodiesFallAsOneUntilTheyLand) {
  const Scene scene = read_scene_text(kBodies, "bodies.toml");
  const SceneState state = run(scene, kFallSteps);
  ASSERT_EQ(state.cloths.size(), 3U);
  const double time = kFallSteps * scene.world.time_step;
  for (std::size_t b = 0; b < state.cloths.size(); ++b) {
    const ClothMesh mesh = make_mesh(scene.cloths[b]);
    const double mass = mesh.masses.sum();
    const Vector3<double> before = mesh.rest_positions * mesh.masses / mass;
    const Vector3<double> after = state.cloths[b].positions * mesh.masses / mass;
    // g t^2 / 2; engines of first order are off by up to g t dt / 2. 1e-5 m: rounding of 50 steps
    // in single precision.
    const double fall = 0.5 * 9.81 * time * time;
    const double error = 0.5 * 9.81 * time * scene.world.time_step + 1e-5;
    EXPECT_NEAR(before.y() - after.y(), fall, error) << state.cloths[b].name;
    EXPECT_NEAR(before.x(), after.x(), 1e-5) << state.cloths[b].name;
    EXPECT_NEAR(before.z(), after.z(), 1e-5) << state.cloths[b].name;
  }
}

TEST_P(EveryEngine, BodiesLandOnTheFloorAndTwoRunsGiveTheSameBits) {
  const Scene scene = read_scene_text(kBodies, "bodies.toml");
  const SceneState first = run(scene, kTotalSteps);
  for (const ClothState& cloth : first.cloths) {
    ASSERT_TRUE(cloth.positions.allFinite());
    // On the floor, at most half a collision margin deep, or bouncing lower than it fell from.
    EXPECT_GE(cloth.positions.row(1).minCoeff(), -0.005) << cloth.name;
    EXPECT_LE(cloth.positions.row(1).minCoeff(), 0.1) << cloth.name;
  }
  const SceneState second = run(scene, kTotalSteps);
  for (std::size_t b = 0; b < first.cloths.size(); ++b) {
    EXPECT_EQ(first.cloths[b].positions, second.cloths[b].positions);
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, EveryEngine,
                         testing::ValuesIn(engine_table().begin(), engine_table().end()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace weft::scenes
