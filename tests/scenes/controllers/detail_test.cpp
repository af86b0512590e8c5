// Levels of detail by themselves: what the controller asks for, with a stand-in for the engine.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/controllers/detail.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

Cloth small_cloth() {
  Cloth cloth;
  cloth.name = "cloth";
  cloth.grid().nodes = {4, 5};
  cloth.grid().size = {0.6, 0.8};
  return cloth;
}

/// A cloth that an animation leads, and what the controller makes of it.
struct Stage {
  explicit Stage(const Detail& detail, const Cloth& cloth = small_cloth())
      : controller(detail, 0, cloth), rest(make_mesh(cloth).rest_positions) {
    state.cloths.push_back({cloth.name, rest, Matrix3X<double>::Zero(3, rest.cols())});
  }

  /// A step to end_time in which the animation brings every node offset away from its rest. Returns
  /// whether the cloth was placed.
  bool step(double end_time, const Vector3<double>& offset) {
    StepCommands commands;
    commands.cloths.resize(1);
    commands.cloths[0].animated_positions = rest.colwise() + offset;
    return take(end_time, commands);
  }

  bool take(double end_time, StepCommands& commands) {
    controller.steer(state, end_time, commands);
    state.time = end_time;
    if (!commands.cloths[0].placement) return false;
    state.cloths[0].positions = commands.cloths[0].placement->positions;
    state.cloths[0].velocities = commands.cloths[0].placement->velocities;
    return true;
  }

  [[nodiscard]] Vector3<double> offset() const {
    return (state.cloths[0].positions - rest).rowwise().mean();
  }
  [[nodiscard]] Vector3<double> velocity() const {
    return state.cloths[0].velocities.rowwise().mean();
  }

  DetailController controller;
  Matrix3X<double> rest;
  SceneState state;
};

const Vector3<double> kNowhere(0, 0, 0);

TEST(Detail, DoesNothingToAClothInFullDetail) {
  Stage stage({.cloth = "cloth"});
  EXPECT_FALSE(stage.step(0.1, kNowhere));
  EXPECT_EQ(stage.controller.level(), DetailLevel::kFull);
}

TEST(Detail, FollowsItsListAndTheProgram) {
  Stage stage({.cloth = "cloth", .levels = {{0.2, DetailLevel::kSkin}, {0.4, DetailLevel::kFull}}});
  EXPECT_FALSE(stage.step(0.1, kNowhere));
  EXPECT_TRUE(stage.step(0.2, kNowhere));
  EXPECT_TRUE(stage.step(0.3, kNowhere));
  EXPECT_FALSE(stage.step(0.4, kNowhere));
  stage.controller.set_level(DetailLevel::kSimplified);
  EXPECT_TRUE(stage.step(0.5, kNowhere));
  EXPECT_EQ(stage.controller.level(), DetailLevel::kSimplified);
}

// Closed form of a critically damped point that starts 1 m from its place with 2 m/s.
TEST(Detail, SimplifiedIsADampedPointWhateverTheStep) {
  const double follow = 0.8;  // [Hz]
  const double w = 2 * std::numbers::pi * follow;
  const double time = 0.37;
  const double expected = (1.0 + (2.0 + w) * time) * std::exp(-w * time);
  for (const int num_steps : {1, 2, 50}) {
    Stage stage({.cloth = "cloth", .levels = {{0.0, DetailLevel::kSimplified}}, .follow = follow});
    stage.step(0.0 + 1e-12, kNowhere);  // the animation has been where it is
    stage.state.cloths[0].positions.row(0).array() += 1.0;
    stage.state.cloths[0].velocities.row(0).setConstant(2.0);
    for (int i = 1; i <= num_steps; ++i) stage.step(time * i / num_steps, kNowhere);
    EXPECT_NEAR(stage.offset().x(), expected, 1e-11) << num_steps;
  }
}

TEST(Detail, SkinBlendsPlaceAndVelocityWithinItsTime) {
  Stage stage({.cloth = "cloth", .blend = 0.4});
  const Vector3<double> speed(0, 0.5, 0);  // of the animation [m/s]
  stage.step(1e-3, 1e-3 * speed);
  stage.state.cloths[0].positions.row(0).array() += 0.3;
  stage.state.cloths[0].velocities.row(0).setConstant(-1.0);
  const Vector3<double> before = stage.offset();
  const Vector3<double> velocity = stage.velocity();
  stage.controller.set_level(DetailLevel::kSkin);
  stage.step(2e-3, 2e-3 * speed);
  // One step of 1 ms: the cubic's acceleration is below 6 offset / blend^2 + 4 change / blend.
  const double acceleration = 6 * 0.3 / 0.16 + 4 * 1.2 / 0.4;
  EXPECT_LT((stage.offset() - before - 1e-3 * velocity).norm(), 0.5e-6 * acceleration + 1e-3);
  EXPECT_LT((stage.velocity() - velocity).norm(), 1e-3 * acceleration + 0.5);
  for (int i = 3; i <= 410; ++i) stage.step(1e-3 * i, 1e-3 * i * speed);
  EXPECT_LT((stage.offset() - 0.41 * speed).norm(), 1e-14);
  EXPECT_LT((stage.velocity() - speed).norm(), 1e-10);
}

TEST(Detail, SimplifiedKeepsTheLimitsOfTheCloth) {
  Stage stage({.cloth = "cloth", .levels = {{0.0, DetailLevel::kSimplified}}, .follow = 0.5});
  for (int i = 1; i <= 30; ++i) {
    StepCommands commands;
    commands.cloths.resize(1);
    ClothCommands& lead = commands.cloths[0];
    lead.animated_positions = stage.rest.colwise() + Vector3<double>(0.1 * i, 0, 0);
    lead.limits.centers = lead.animated_positions;
    lead.limits.max_distances = VectorX<double>::Constant(stage.rest.cols(), 0.05);
    ASSERT_TRUE(stage.take(0.01 * i, commands));
    const Matrix3X<double> gap = stage.state.cloths[0].positions - lead.animated_positions;
    EXPECT_LE(gap.colwise().norm().maxCoeff(), 0.05 + 1e-12);
  }
}

TEST(Detail, WithoutAnAnimationThePinsCarryTheShape) {
  Cloth cloth = small_cloth();
  cloth.pins = {EdgePin{.axis = 1, .side = 0}};
  Stage stage({.cloth = "cloth", .levels = {{0.0, DetailLevel::kSkin}}, .blend = 0.0}, cloth);
  const std::vector<int> pinned = make_mesh(cloth).pinned;
  // The edge turns about the vertical through the origin; it is a straight line, so that the turn
  // about itself is open, and must stay.
  for (int i = 1; i <= 20; ++i) {
    const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.05 * i, Vector3<double>::UnitY()));
    StepCommands commands;
    commands.cloths.resize(1);
    commands.cloths[0].pinned_positions = turn * stage.rest(Eigen::all, pinned);
    ASSERT_TRUE(stage.take(0.01 * i, commands));
    EXPECT_LT((stage.state.cloths[0].positions - turn * stage.rest).norm(), 1e-4) << i;
  }
}

TEST(Detail, RefusesWhatItCannotDo) {
  Cloth torn = small_cloth();
  torn.tear = ClothTear();
  EXPECT_THROW(DetailController({.cloth = "cloth"}, 0, torn), InvalidArgument);
  EXPECT_THROW(DetailController({.cloth = "cloth", .blend = -1.0}, 0, small_cloth()),
               InvalidArgument);
  EXPECT_THROW(DetailController({.cloth = "cloth", .follow = 0.0}, 0, small_cloth()),
               InvalidArgument);
  const std::vector<DetailSwitch> back = {{1.0, DetailLevel::kSkin}, {0.5, DetailLevel::kFull}};
  EXPECT_THROW(DetailController({.cloth = "cloth", .levels = back}, 0, small_cloth()),
               InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
