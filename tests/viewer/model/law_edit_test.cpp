#include <weft/viewer/model/law_edit.hpp>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>

namespace weft::viewer {
namespace {

const Parameter& find(const std::vector<Parameter>& all, const std::string& label) {
  for (const Parameter& parameter : all) {
    if (parameter.label == label) return parameter;
  }
  throw std::runtime_error("no parameter " + label);
}

TEST(LawEdit, ListsEveryNumberWithItsUnit) {
  const auto all = parameters_of(scenes::load_scene("hang"));
  EXPECT_EQ(find(all, "tension stiffness").value, 60.0);
  EXPECT_EQ(find(all, "tension stiffness").unit, "N/m");
  EXPECT_EQ(find(all, "gravity acceleration y").value, -9.81);
  EXPECT_EQ(find(all, "tension compression_ratio").value, 1.0);  // a default
  EXPECT_EQ(all.size(), 3u + 2u + 1u + 1u);
}

TEST(LawEdit, SetsOneNumberAndRefusesWhatTheLawRefuses) {
  scenes::Scene scene = scenes::load_scene("hang");
  const auto all = parameters_of(scene);
  set_parameter(scene, find(all, "tension stiffness"), 80.0);
  EXPECT_EQ(find(parameters_of(scene), "tension stiffness").value, 80.0);
  EXPECT_EQ(find(parameters_of(scene), "spring_damping damping").value, 0.002);
  EXPECT_THROW(set_parameter(scene, find(all, "tension stiffness"), -1.0), InvalidArgument);
  EXPECT_EQ(find(parameters_of(scene), "tension stiffness").value, 80.0);
}

TEST(LawEdit, EverySliderOfTheCatalogHoldsItsValue) {
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    for (const Parameter& parameter : parameters_of(scenes::load_scene(std::string(entry.name)))) {
      const SliderRange range = slider_range(parameter);
      EXPECT_LT(range.low, range.high) << entry.name << " " << parameter.label;
      EXPECT_LE(range.low, parameter.value) << entry.name << " " << parameter.label;
      EXPECT_GE(range.high, parameter.value) << entry.name << " " << parameter.label;
      EXPECT_GE(range.low, parameter.minimum) << entry.name << " " << parameter.label;
      EXPECT_LE(range.high, parameter.maximum) << entry.name << " " << parameter.label;
      EXPECT_TRUE(!range.is_logarithmic || range.low > 0.0) << entry.name << parameter.label;
    }
  }
}

TEST(LawEdit, WindIsAddedWhereThereIsNone) {
  scenes::Scene scene = scenes::load_scene("hang");
  EXPECT_EQ(wind_of(scene), Vector3<double>(0, 0, 0));
  EXPECT_EQ(add_wind(scene, {0.5, 0.0, -1.0}), 1);
  EXPECT_EQ(add_wind(scene, {0.5, 0.0, 0.0}), 1);
  EXPECT_EQ(wind_of(scene), Vector3<double>(1.0, 0.0, -1.0));
  EXPECT_EQ(scene.cloths[0].laws.size(), 5u);
}

TEST(LawEdit, EveryClothGetsTheSameChangeOfWind) {
  scenes::Scene scene = scenes::load_scene("wind");
  EXPECT_EQ(add_wind(scene, {0.0, 1.0, 0.0}), 2);
  EXPECT_EQ(wind_of(scene), Vector3<double>(6.0, 1.0, 1.0));
}

TEST(LawEdit, GravityChangesForClothAndRigidBodies) {
  scenes::Scene scene = scenes::load_scene("ball_on_cloth");
  add_gravity(scene, {1.0, 0.0, 0.0});
  EXPECT_EQ(gravity_of(scene), Vector3<double>(1.0, -9.81, 0.0));
  EXPECT_EQ(scene.world.gravity, Vector3<double>(1.0, -9.81, 0.0));
}

}  // namespace
}  // namespace weft::viewer
