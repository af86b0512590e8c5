#include <weft/scenes/scene_warnings.hpp>

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/engine_kind.hpp>

namespace weft::scenes {
namespace {

using Kind = forces::SetUpWarning::Kind;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<Kind> kinds_of(const Scene& scene, std::string_view engine,
                           bool is_single_precision = true) {
  std::vector<Kind> kinds;
  for (const SceneWarning& found :
       find_warnings(scene, {std::string(engine)}, is_single_precision)) {
    kinds.push_back(found.warning.kind);
  }
  return kinds;
}

TEST(SceneWarnings, ScenesOfTheCatalogHaveNoneForTheirEngines) {
  for (const CatalogEntry& entry : scene_catalog()) {
    const Scene scene = load_scene(std::string(entry.name));
    const std::vector<std::string> engines =
        engine_names([&](const EngineKind& kind) { return is_for_engine(scene, kind.name); });
    for (const SceneWarning& found : find_warnings(scene, engines, true)) {
      // Its model has them, at the seams of the eyes.
      if (found.cloth == "sock" && found.warning.kind == Kind::kSharpTriangles) continue;
      ADD_FAILURE() << scene.name << ", " << found.engines[0] << ", " << found.cloth << ": "
                    << found.warning.message;
    }
  }
}

TEST(SceneWarnings, ALongStepIsForExplicitEnginesOnly) {
  Scene scene = load_scene("hang");
  scene.world.time_step = 0.05;
  scene.world.implicit_time_step.reset();
  EXPECT_THAT(kinds_of(scene, "bullet_forces"), ElementsAre(Kind::kUnstableStep));
  EXPECT_THAT(kinds_of(scene, "reference"), ElementsAre(Kind::kUnstableStep));
  EXPECT_THAT(kinds_of(scene, "bullet_weft"), IsEmpty());
  EXPECT_THAT(kinds_of(scene, "bullet_soft"), IsEmpty());
  scene.reference.integrator = Integrator::kTrBdf2;
  EXPECT_THAT(kinds_of(scene, "reference"), IsEmpty());
  scene.reference.integrator = Integrator::kVelocityVerlet;
  scene.reference.step_guard = StepGuard::kSubstep;
  EXPECT_THAT(kinds_of(scene, "reference"), IsEmpty());
}

TEST(SceneWarnings, LimitsOfStiffnessAreThoseOfThePrecision) {
  Scene scene = load_scene("hang");
  scene.world.time_step = 1.0 / 60;
  scene.world.implicit_time_step.reset();
  for (forces::LawSpecification& law : scene.cloths[0].laws) {
    if (law.law == "tension") law.parameters["stiffness"] = {1e7};
  }
  ASSERT_THAT(kinds_of(scene, "bullet_weft"), ElementsAre(Kind::kSofterSprings));
  scene.world.time_step /= 2;  // a quarter of k h^2 / m, between the two limits
  EXPECT_THAT(kinds_of(scene, "bullet_weft", false), IsEmpty());
}

TEST(SceneWarnings, ExtentsAreThoseOfTheThinnestPart) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const auto expect = [](const Shape& shape, double least, double middle) {
    EXPECT_EQ(half_extents(shape).least, least);
    EXPECT_EQ(half_extents(shape).middle, middle);
  };
  expect(SphereShape{0.3}, 0.3, 0.3);
  expect(BoxShape{{0.3, 0.1, 0.2}}, 0.1, 0.2);
  expect(PlaneShape{}, kEndless, kEndless);
  expect(CapsuleShape{0.2, 0.1}, 0.2, 0.2);
  expect(CylinderShape{0.2, 0.1}, 0.05, 0.2);
  expect(ConeShape{0.2, 1.0}, 0.2, 0.2);
  expect(CompoundShape{{{SphereShape{0.3}}, {BoxShape{{0.2, 0.6, 0.5}}}}}, 0.2, 0.3);
  expect(HeightFieldShape{{1, 1}, Eigen::MatrixXd::Zero(2, 2)}, kEndless, kEndless);
}

TEST(SceneWarnings, AnUnknownEngineIsRefused) {
  EXPECT_THROW((void)find_warnings(load_scene("hang"), {"bullet"}, true), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
