#include <weft/validation/converged/converged_reference.hpp>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::validation {
namespace {

/// A small cloth that swings down from two corners.
scenes::Scene small_hang() {
  return scenes::read_scene_text(R"(schema = "weft-scene/1"
name = "small_hang"
[world]
time_step = "1/500 s"
duration = "1 s"
frame_interval = "1/50 s"
[[cloth]]
name = "cloth"
grid = { nodes = [6, 6], size = ["1 m", "1 m"], stencil = "12-neighbour" }
mass = "0.2 kg"
pin = [{ corner = "-u-v" }, { corner = "+u-v" }]
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "tension"
stiffness = "50 N/m"
[[cloth.law]]
law = "velocity_damping"
rate = "1 1/s"
)",
                                 "small_hang.toml");
}

TEST(ConvergedReference, OfASwingHasTheOrdersOfItsMethodsAndTheyAgree) {
  const ConvergedReference found = converge(small_hang(), {.time = 0.2, .num_levels = 4});
  ASSERT_EQ(found.studies.size(), 2U);
  constexpr double kOrderTolerance = 0.15;
  for (const ConvergenceStudy& study : found.studies) {
    ASSERT_EQ(study.levels.size(), 4U);
    ASSERT_TRUE(study.order && study.gci);
    EXPECT_NEAR(*study.order, 2.0, kOrderTolerance);
    EXPECT_FALSE(study.levels.front().difference);
    for (std::size_t n = 1; n < 4; ++n) {
      EXPECT_EQ(study.levels[n].num_steps, 2 * study.levels[n - 1].num_steps);
      EXPECT_NE(study.levels[n].hash, study.levels[n - 1].hash);
    }
  }
  // Independent methods: what lies between them is what both say of their errors.
  ASSERT_TRUE(found.agreement);
  EXPECT_GT(*found.agreement, 0.0);
  EXPECT_LT(*found.agreement, *found.studies[0].gci + *found.studies[1].gci);
  EXPECT_TRUE(found.is_converged());
}

TEST(ConvergedReference, IsTheSameBitsAgain) {
  const ConvergenceOptions options{.time = 0.02, .num_levels = 3};
  EXPECT_EQ(to_json(converge(small_hang(), options)), to_json(converge(small_hang(), options)));
}

TEST(ConvergedReference, TellsABlowUpAndIsThenNotConverged) {
  scenes::Scene scene = small_hang();
  scene.cloths[0].laws[1].parameters["stiffness"] = {5e5};  // far beyond Verlet's stable step
  const ConvergedReference found = converge(scene, {.time = 0.2, .num_levels = 3});
  EXPECT_TRUE(found.studies[0].levels[0].blow_up);
  EXPECT_FALSE(found.studies[0].levels[1].difference);
  EXPECT_FALSE(found.is_converged());
  EXPECT_NE(to_json(found).find("blow_up"), std::string::npos);
}

TEST(ConvergedReference, AnotherMeshOrSceneHasAnotherHash) {
  const ConvergenceOptions options{.time = 0.002, .num_levels = 3};
  const ConvergedReference one = converge(small_hang(), options);
  scenes::Scene heavier = small_hang();
  heavier.cloths[0].grid().total_mass = 0.3;
  const ConvergedReference other = converge(heavier, options);
  EXPECT_NE(one.scene_hash, other.scene_hash);
  EXPECT_NE(one.mesh_hash, other.mesh_hash);
  scenes::Scene renamed = small_hang();
  renamed.name = "renamed";
  EXPECT_EQ(converge(renamed, options).mesh_hash, one.mesh_hash);
}

TEST(ConvergedReference, OptionsOutOfTheirDomainAreRefused) {
  EXPECT_THROW((void)converge(small_hang(), {.time = 0.0}), InvalidArgument);
  EXPECT_THROW((void)converge(small_hang(), {.time = 0.0031}), InvalidArgument);
  EXPECT_THROW((void)converge(small_hang(), {.time = 0.2, .num_levels = 2}), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
