#include <weft/custom_forces/set_up_warnings.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/custom_forces/spectrum.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::forces {
namespace {

using Kind = SetUpWarning::Kind;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kEdge = 0.1;   ///< of nodes [m]
constexpr double kMass = 0.36;  ///< 10 g a node [kg]
constexpr double kJustBelow = 1 - 1e-6;
constexpr double kJustAbove = 1 + 1e-6;

LawSpecification springs(double stiffness) {
  return {"tension", {}, {{"stiffness", {stiffness}}}};
}

/// 6 x 6 nodes, which nothing is wrong with.
ClothSetUp good() {
  return {.mesh = make_cloth_grid({.nodes = {6, 6},
                                   .size = {5 * kEdge, 5 * kEdge},
                                   .total_mass = kMass,
                                   .lumping = MassLumping::kUniform}),
          .laws = {springs(100)},
          .time_step = 1e-3,
          .margin = 0.01,
          .colliders = {
              {.name = "ball", .least_half_extent = 0.2, .middle_half_extent = 0.2, .mass = 1.0}}};
}

std::vector<Kind> kinds_of(const ClothSetUp& set_up) {
  std::vector<Kind> kinds;
  for (const SetUpWarning& warning : find_warnings(set_up)) kinds.push_back(warning.kind);
  return kinds;
}

/// The one warning there is.
std::string message_of(const ClothSetUp& set_up) {
  const std::vector<SetUpWarning> warnings = find_warnings(set_up);
  EXPECT_EQ(warnings.size(), 1U);
  return warnings.empty() ? "" : warnings[0].message;
}

TEST(SetUpWarnings, AGoodSetUpHasNone) {
  EXPECT_THAT(find_warnings(good()), IsEmpty());
}

TEST(SetUpWarnings, AStepBeyondTheStableOneIsNamedWithIt) {
  ClothSetUp set_up = good();
  const double stable = critical_time_step(set_up.mesh, set_up.laws);
  set_up.time_step = kJustBelow * stable;
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
  set_up.time_step = kJustAbove * stable;
  EXPECT_THAT(message_of(set_up), HasSubstr("blow up"));
  set_up.is_always_stable = true;
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
}

TEST(SetUpWarnings, SpringsThatAreSolvedSofterAreNamed) {
  ClothSetUp set_up = good();
  set_up.is_always_stable = true;
  set_up.most_stiffness = 1e6;
  set_up.time_step = 1.0 / 60;
  const double limit = set_up.most_stiffness * (kMass / 36) * 60 * 60;  // k of k h^2 / m = 1e6
  set_up.laws = {springs(kJustBelow * limit)};
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
  set_up.laws = {springs(7 * limit)};
  EXPECT_THAT(message_of(set_up), HasSubstr("7 times as soft"));
  // A node that does not move has no say.
  set_up.mesh.masses[0] /= 1000;
  set_up.laws = {springs(kJustBelow * limit)};
  EXPECT_THAT(kinds_of(set_up), ElementsAre(Kind::kSofterSprings));
  set_up.mesh.pinned = {0};
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
}

TEST(SetUpWarnings, SharpTrianglesAreCounted) {
  ClothSetUp set_up = good();
  set_up.laws.clear();
  set_up.mesh.rest_positions.row(1) *= 0.01;
  set_up.mesh.rest_positions.row(2) *= 0.01;
  EXPECT_THAT(message_of(set_up), HasSubstr("50 of 50 triangles"));
}

TEST(SetUpWarnings, AColliderThatFitsBetweenNodesIsNamed) {
  ClothSetUp set_up = good();
  const double gap = kEdge / std::sqrt(2.0);  // from the middle of a cell to its nodes
  set_up.colliders = {{.name = "pin", .middle_half_extent = kJustAbove * gap - set_up.margin}};
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
  set_up.colliders[0].middle_half_extent = kJustBelow * gap - set_up.margin;
  EXPECT_THAT(message_of(set_up), HasSubstr("'pin'"));
}

TEST(SetUpWarnings, AColliderThatIsCrossedInAStepIsNamedWhereContactsAreNotSwept) {
  ClothSetUp set_up = good();
  set_up.laws.clear();
  set_up.time_step = 0.01;
  set_up.speed = 30;
  set_up.colliders = {{.name = "board", .least_half_extent = 0.07, .mass = 1.0, .speed = 10}};
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
  set_up.is_swept = false;
  EXPECT_THAT(kinds_of(set_up), ElementsAre(Kind::kThinCollider));
  set_up.speed = 5;  // 15 cm in a step, of 16 with both margins
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
}

TEST(SetUpWarnings, MassRatiosThatNoTestCoversAreNamed) {
  ClothSetUp set_up = good();
  for (const double ratio : {0.999e3, 1.001e-3}) {
    set_up.colliders[0].mass = ratio * kMass;
    EXPECT_THAT(kinds_of(set_up), IsEmpty()) << ratio;
  }
  for (const double ratio : {1.001e3, 0.999e-3}) {
    set_up.colliders[0].mass = ratio * kMass;
    EXPECT_THAT(kinds_of(set_up), ElementsAre(Kind::kMassRatio)) << ratio;
  }
}

TEST(SetUpWarnings, LayersWantShortStepsAndAThicknessOfHalfAnEdge) {
  ClothSetUp set_up = good();
  set_up.laws.clear();
  set_up.layer_distance = kJustAbove * kEdge / 2;
  set_up.time_step = static_cast<double>(1.0F / 150);
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
  set_up.meets_cloth = true;
  EXPECT_THAT(kinds_of(set_up), ElementsAre(Kind::kLayersInLongSteps));
  set_up.time_step = 1.0 / 250;
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
  set_up.layer_distance = kJustBelow * kEdge / 2;
  EXPECT_THAT(kinds_of(set_up), ElementsAre(Kind::kThinLayers));
  set_up.time_step = 1.0 / 60;
  set_up.keeps_layers_apart = true;
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
}

TEST(SetUpWarnings, RoundingFarFromTheOriginIsNamed) {
  ClothSetUp set_up = good();
  set_up.mesh.rest_positions.row(0).array() += 1000;  // 6e-5 m, of edges of 0.1 m
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
  set_up.is_single_precision = true;
  EXPECT_THAT(kinds_of(set_up), ElementsAre(Kind::kFarFromOrigin));
}

TEST(SetUpWarnings, GravityThatActsTwiceIsNamed) {
  ClothSetUp set_up = good();
  set_up.world_gravity = {0, -9.81, 0};
  EXPECT_THAT(kinds_of(set_up), IsEmpty());
  set_up.laws.push_back({"gravity", {}, {{"acceleration", {0, -9.81, 0}}}});
  EXPECT_THAT(message_of(set_up), HasSubstr("9.81 m/s^2"));
}

TEST(SetUpWarnings, AStepThatIsNoneIsRefused) {
  ClothSetUp set_up = good();
  for (const double step : {0.0, -1.0, std::nan("")}) {
    set_up.time_step = step;
    EXPECT_THROW((void)find_warnings(set_up), InvalidArgument);
  }
}

TEST(SetUpWarnings, EveryKindHasANameOfItsOwn) {
  EXPECT_EQ(name_of(Kind::kUnstableStep), "unstable_step");
  EXPECT_EQ(name_of(Kind::kThinLayers), "thin_layers");
  EXPECT_EQ(name_of(Kind::kGravityTwice), "gravity_twice");
}

}  // namespace
}  // namespace weft::forces
