#include <weft/viewer/live/step_parts.hpp>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/viewer/model/law_edit.hpp>

namespace weft::viewer {
namespace {

scenes::SceneState at_rest(const scenes::Scene& scene) {
  scenes::SceneState state;
  for (const scenes::Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = scenes::make_mesh(cloth);
    state.cloths.push_back(
        {cloth.name, mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes())});
  }
  return state;
}

scenes::Scene with_stiffness(double factor) {
  scenes::Scene scene = scenes::load_scene("hang");
  for (forces::LawSpecification& law : scene.cloths[0].laws) {
    if (law.law == "tension") law.parameters["stiffness"] = {60.0 * factor};
  }
  return scene;
}

int parts_of(const char* engine, const scenes::Scene& scene) {
  StepParts parts(engine);
  parts.set_laws(scene);
  return parts.count(at_rest(scene), scene.world.time_step);
}

TEST(StepPart, StepsAreWholeUntilLawsChange) {
  const scenes::Scene scene = with_stiffness(1e6);
  StepParts parts("reference");
  EXPECT_EQ(parts.count(at_rest(scene), scene.world.time_step), 1);
}

TEST(StepPart, StifferSpringsNeedTheRootOfTheirStiffness) {
  const int soft = parts_of("reference", with_stiffness(25.0));
  const int stiff = parts_of("reference", with_stiffness(400.0));
  EXPECT_GT(soft, 1);
  EXPECT_NEAR(stiff, 4.0 * soft, 4.0);
  EXPECT_EQ(parts_of("bullet_forces", with_stiffness(25.0)), soft);
  EXPECT_EQ(parts_of("reference", with_stiffness(1e9)), StepParts::kMaxParts);
}

TEST(StepPart, ImplicitSpringsAndFixedStepsStayWhole) {
  EXPECT_EQ(parts_of("bullet_weft", with_stiffness(400.0)), 1);
  EXPECT_EQ(parts_of("bullet_soft", with_stiffness(400.0)), 1);
}

TEST(StepPart, AStrongWindOnLightClothCounts) {
  scenes::Scene scene = scenes::load_scene("drape_sphere");
  (void)add_wind(scene, {0.0, 30.0, 0.0});
  EXPECT_GT(parts_of("reference", scene), 4);
  EXPECT_GT(parts_of("bullet_weft", scene), 4);
}

}  // namespace
}  // namespace weft::viewer
