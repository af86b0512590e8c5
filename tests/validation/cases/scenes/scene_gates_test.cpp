#include <weft/validation/cases/scenes/scene_gates.hpp>

#include <set>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases.hpp>

namespace weft::validation {
namespace {

// A scene for all engines compares them; one that names its engines has invariants under
// tests/catalog.
TEST(SceneGates, EveryCatalogSceneForAllEnginesIsACaseWithGates) {
  std::set<std::string> ids;
  for (const CaseInfo& info : all_cases()) ids.insert(std::string(info.id));
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    const std::string name(entry.name);
    if (!scenes::load_scene(name).engines.empty()) continue;
    EXPECT_TRUE(ids.contains(name)) << name;
    EXPECT_FALSE(scene_gates(name).empty()) << name;
  }
}

TEST(SceneGates, EveryGateHasASabotageABasisAndANote) {
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    const scenes::Scene scene = scenes::load_scene(std::string(entry.name));
    for (const SceneGate& gate : scene_gates(scene.name)) {
      SCOPED_TRACE(scene.name + " " + gate.engine.title() + " " + gate.claim);
      EXPECT_FALSE(gate.sabotages.empty());
      EXPECT_FALSE(gate.tolerance.why.empty());
      EXPECT_FALSE(gate.note.empty());
      EXPECT_GT(gate.tolerance.value, 0.0);
      EXPECT_LE(gate.begin, gate.end);
      EXPECT_LE(gate.end, scene.world.duration);
    }
  }
}

// A reference with the engine's own step is no solution: only what holds between equal recurrences may be held against it.
TEST(SceneGates, OnlyRoundOffIsHeldAgainstTheSameRecurrence) {
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    for (const SceneGate& gate : scene_gates(std::string(entry.name))) {
      if (gate.quantity == Quantity::kDepth) continue;  // needs no reference
      SCOPED_TRACE(std::string(entry.name) + " " + gate.engine.title() + " " + gate.claim);
      EXPECT_EQ(gate.against == Against::kScheme, gate.tolerance.basis == Basis::kRoundoff);
    }
  }
}

TEST(Cases, IdsAreUnique) {
  std::set<std::string_view> ids;
  for (const CaseInfo& info : all_cases()) EXPECT_TRUE(ids.insert(info.id).second) << info.id;
}

}  // namespace
}  // namespace weft::validation
