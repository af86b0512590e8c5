#include <weft/validation/cases/scenes/scene_bounds.hpp>

#include <set>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases.hpp>

namespace weft::validation {
namespace {

// A scene for all engines compares them; one that names its engines has invariants under
// tests/catalog.
TEST(SceneBounds, EveryCatalogSceneForAllEnginesIsACaseWithBounds) {
  std::set<std::string> ids;
  for (const CaseInfo& info : all_cases()) ids.insert(std::string(info.id));
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    const std::string name(entry.name);
    if (!scenes::load_scene(name).engines.empty()) continue;
    EXPECT_TRUE(ids.contains(name)) << name;
    EXPECT_FALSE(scene_bounds(name).empty()) << name;
  }
}

TEST(SceneBounds, EveryGateHasASabotageABasisAndANote) {
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    const scenes::Scene scene = scenes::load_scene(std::string(entry.name));
    for (const SceneBound& bound : scene_bounds(scene.name)) {
      SCOPED_TRACE(scene.name + " " + bound.engine.title() + " " + bound.claim);
      EXPECT_FALSE(bound.sabotages.empty());
      EXPECT_FALSE(bound.tolerance.why.empty());
      EXPECT_FALSE(bound.note.empty());
      EXPECT_GT(bound.tolerance.value, 0.0);
      EXPECT_LE(bound.begin, bound.end);
      EXPECT_LE(bound.end, scene.world.duration);
    }
  }
}

// A reference with the engine's own step is no solution: only what holds between equal recurrences may be held against it.
TEST(SceneBounds, OnlyRoundOffIsHeldAgainstTheSameRecurrence) {
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    for (const SceneBound& bound : scene_bounds(std::string(entry.name))) {
      if (bound.quantity == Quantity::kDepth) continue;  // needs no reference
      SCOPED_TRACE(std::string(entry.name) + " " + bound.engine.title() + " " + bound.claim);
      EXPECT_EQ(bound.against == Against::kScheme, bound.tolerance.basis == Basis::kRoundoff);
    }
  }
}

TEST(Cases, IdsAreUnique) {
  std::set<std::string_view> ids;
  for (const CaseInfo& info : all_cases()) EXPECT_TRUE(ids.insert(info.id).second) << info.id;
}

}  // namespace
}  // namespace weft::validation
