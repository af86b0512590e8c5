#include <weft/validation/referee/judged_cases.hpp>

#include <set>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::validation {
namespace {

using scenes::samples::TemporaryFolder;

/// A recording of one frame: every body where the scene starts it.
void record_start(const std::filesystem::path& path, const scenes::Scene& scene) {
  scenes::RecordingWriter writer(path, scene, {}, scenes::StoredPrecision::kFloat64);
  scenes::SceneState state;
  for (const scenes::Cloth& cloth : scene.cloths) {
    const Matrix3X<double> rest = scenes::make_mesh(cloth).rest_positions;
    state.cloths.push_back({cloth.name, rest, 0.0 * rest});
  }
  for (const scenes::Collider& collider : scene.colliders) {
    state.rigids.push_back({collider.name, collider.position, collider.orientation});
  }
  writer.add_frame(state);
  writer.finish();
}

std::string fault_of(const std::vector<std::string>& names, RecordedResult recorded) {
  try {
    (void)case_of_recording(names, recorded);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "none";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A case that is in neither list would be passed over in silence.
TEST(JudgedCases, EveryCaseIsJudgedOrListedAsNotJudged) {
  std::multiset<std::string_view> listed;
  for (const NotJudged& group : not_judged()) listed.insert(group.cases.begin(), group.cases.end());
  for (const CaseInfo& info : all_cases()) {
    EXPECT_EQ(listed.count(info.id), info.recordable == nullptr ? 1U : 0U) << info.id;
    listed.erase(info.id);
  }
  EXPECT_TRUE(listed.empty()) << *listed.begin() << " is no case";
}

TEST(JudgedCases, NoTwoScenesAskTheSame) {
  std::vector<scenes::Scene> all;
  for (const CaseInfo& info : all_cases()) {
    if (info.recordable == nullptr) continue;
    for (const scenes::Scene& scene : info.recordable(info)) {
      for (const scenes::Scene& other : all) {
        EXPECT_FALSE(ask_the_same(scene, other)) << scene.name << " and " << other.name;
      }
      all.push_back(scene);
    }
  }
  EXPECT_EQ(all.size(), 39U) << "seven of the catalog, 32 of the sweep";
}

TEST(JudgedCases, AreFoundByTheScene) {
  const TemporaryFolder folder;
  scenes::Scene scene = scenes::load_scene("drop_box");
  scene.name = "my_copy";
  scene.world.time_step = 1.0 / 500;
  record_start(folder / "a.weftrec", scene);
  RecordedResult recorded = recorded_result(folder / "a.weftrec");
  EXPECT_EQ(case_of_recording({}, recorded).id, "drop_box");
  EXPECT_EQ(recorded.scene.name, "drop_box") << "everything is measured by the case's scene";

  scene.cloths[0].laws[1].parameters.at("stiffness").at(0) *= 1.01;
  record_start(folder / "b.weftrec", scene);
  const std::string fault = fault_of({}, recorded_result(folder / "b.weftrec"));
  EXPECT_TRUE(has(fault, "b.weftrec: scene 'my_copy' is not that of a case, expected")) << fault;
}

TEST(JudgedCases, CanBeNamedForARecordingWithoutLaws) {
  const TemporaryFolder folder;
  scenes::Scene scene = scenes::load_scene("hang");
  scene.cloths[0].laws.clear();
  record_start(folder / "a.weftrec", scene);
  RecordedResult recorded = recorded_result(folder / "a.weftrec");
  EXPECT_EQ(case_of_recording({"hang"}, recorded).id, "hang");
  EXPECT_FALSE(recorded.scene.cloths[0].laws.empty());
  const RecordedResult other = recorded_result(folder / "a.weftrec");
  EXPECT_TRUE(has(fault_of({"drop_box"}, other), "cloths and 0 rigid bodies, expected 1 and 1"));
  EXPECT_TRUE(has(fault_of({"collision_sweep"}, other), "scene 'hang' is none of the 32 of case"));
  EXPECT_TRUE(
      has(fault_of({"cantilever"}, other), "case 'cantilever' cannot be judged from a recording"));
  EXPECT_TRUE(has(fault_of({"hang", "drop_box"}, other), "2 cases for one recording"));
}

TEST(JudgedCases, HaveBoundsOfAnEngine) {
  const TemporaryFolder folder;
  record_start(folder / "a.weftrec", scenes::load_scene("hang"));
  RecordedResult recorded = recorded_result(folder / "a.weftrec");
  recorded.judged_as = "reference";
  EXPECT_TRUE(has(fault_of({}, recorded), "--engine reference: has no bounds for a recording"));
}

}  // namespace
}  // namespace weft::validation
