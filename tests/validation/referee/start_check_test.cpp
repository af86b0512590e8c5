#include <weft/validation/referee/start_check.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases.hpp>

namespace weft::validation {
namespace {

/// A frame of the scene "hang" with every node moved by a shift [m].
scenes::SceneState moved_start(const scenes::Scene& scene, const Vector3<double>& shift) {
  scenes::SceneState state;
  const Matrix3X<double> rest = scenes::make_mesh(scene.cloths[0]).rest_positions;
  state.cloths.push_back({"cloth", rest.colwise() + shift, 0.0 * rest});
  return state;
}

CheckResult check_of(const Vector3<double>& shift) {
  const scenes::Scene scene = scenes::load_scene("hang");
  History recorded{
      {kRecordingEngine, scenes::StoredPrecision::kFloat32, "bullet_weft"}, {}, {}, "", ""};
  recorded.frames = {moved_start(scene, shift)};
  const Frames reference{moved_start(scene, {0, 0, 0}), moved_start(scene, {0, 0.004, 0})};
  return start_check(all_cases().front(), scene, recorded, reference);
}

TEST(StartCheck, PassesWithinRoundingOnly) {
  EXPECT_EQ(check_of({0, 1e-7, 0}).verdict, Verdict::kPass);
  const CheckResult moved = check_of({0, 0, 1e-4});
  EXPECT_EQ(moved.verdict, Verdict::kFail);
  EXPECT_NEAR(moved.measured, 1e-4, 1e-12);
  EXPECT_EQ(check_of({0, std::nan(""), 0}).verdict, Verdict::kFail);
}

TEST(StartCheck, NoticesAFrameTooLate) {
  const CheckResult check = check_of({0, 0, 0});
  ASSERT_EQ(check.sabotages.size(), 1U);
  EXPECT_TRUE(check.sabotages[0].detected);
  EXPECT_NEAR(check.sabotages[0].measured, 0.004, 1e-12);
  EXPECT_EQ(check.engine, "recording float32");
}

}  // namespace
}  // namespace weft::validation
