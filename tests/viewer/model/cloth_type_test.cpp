#include <weft/viewer/model/cloth_type.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <weft/scenes/catalog.hpp>

namespace weft::viewer {
namespace {

double rigidity_of(const scenes::Cloth& cloth) {
  for (const forces::LawSpecification& law : cloth.laws) {
    if (law.law == "hinge_torsion") return law.parameters.at("rigidity").at(0);
  }
  return 0.0;
}

std::size_t type_named(std::string_view name) {
  const auto types = cloth_types();
  return static_cast<std::size_t>(
      std::find_if(types.begin(), types.end(), [&](const ClothType& t) { return t.name == name; }) -
      types.begin());
}

TEST(ClothTypes, RigidityFollowsFromTheBendingLength) {
  const scenes::Scene written = scenes::load_scene("hang");  // 0.25 kg/m^2
  scenes::Scene scene = written;
  EXPECT_EQ(apply_cloth_type(scene, written, type_named("paper"), false), "");
  EXPECT_NEAR(rigidity_of(scene.cloths[0]), 0.25 * 9.81 * std::pow(0.26, 3), 1e-9);
  EXPECT_EQ(apply_cloth_type(scene, written, type_named("cotton"), false), "");
  EXPECT_NEAR(rigidity_of(scene.cloths[0]), 0.25 * 9.81 * std::pow(0.02, 3), 1e-12);
}

TEST(ClothTypes, AHandkerchiefHasNoBendingAndTheFirstTypeGivesItBack) {
  const scenes::Scene written = scenes::load_scene("drape_torsion");
  scenes::Scene scene = written;
  (void)apply_cloth_type(scene, written, type_named("handkerchief"), false);
  for (const scenes::Cloth& cloth : scene.cloths) {
    for (const auto& law : cloth.laws) EXPECT_NE(law.law, "torsion");
  }
  (void)apply_cloth_type(scene, written, 0, false);
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    EXPECT_EQ(scene.cloths[c].laws.size(), written.cloths[c].laws.size());
  }
  EXPECT_EQ(scene.cloths[3].laws.back().law, "torsion");
}

TEST(ClothTypes, AnExplicitStepHoldsTheRigidityAndSaysSo) {
  const scenes::Scene written = scenes::load_scene("drape_sphere");
  scenes::Scene free = written;
  scenes::Scene held = written;
  free.world.time_step = held.world.time_step = 0.05;
  EXPECT_EQ(apply_cloth_type(free, written, type_named("paper"), false), "");
  const std::string note = apply_cloth_type(held, written, type_named("paper"), true);
  EXPECT_NE(note.find("0.05 s"), std::string::npos) << note;
  EXPECT_LT(rigidity_of(held.cloths[0]), rigidity_of(free.cloths[0]));
}

}  // namespace
}  // namespace weft::viewer
