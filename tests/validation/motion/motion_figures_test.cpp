#include <weft/validation/motion/motion_figures.hpp>

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <weft/validation/motion/motion_scenes.hpp>

namespace weft::validation {
namespace {

std::vector<MotionScene> all_motions() {
  std::vector<MotionScene> list = judged_motions();
  for (MotionScene& motion : judged_impacts()) list.push_back(std::move(motion));
  return list;
}

TEST(MotionFigures, BoundsHoldWhereNothingMoves) {
  for (const MotionScene& motion : all_motions()) {
    for (const MotionFigure& figure : motion.figures) {
      if (!figure.is_bound || figure.wrong == WrongMotion::kUntouched) continue;
      // Momentum of bodies that stand still is none: a share of it is no number.
      if (figure.unit == "1") continue;
      const double value = figure.of(motion.scene, standing_still(motion.scene));
      EXPECT_LE(figure.deviation(value, 0.0), figure.allowed)
          << motion.scene.name << ": " << figure.name;
    }
  }
}

TEST(MotionFigures, BoundsNoticeTheirWrongMotion) {
  for (const MotionScene& motion : all_motions()) {
    for (const MotionFigure& figure : motion.figures) {
      if (!figure.is_bound) continue;
      const double value = figure.of(motion.scene, wrong_motion(motion.scene, figure.wrong));
      EXPECT_FALSE(figure.deviation(value, 0.0) <= figure.allowed)
          << motion.scene.name << ": " << figure.name << " " << value;
    }
  }
}

TEST(MotionFigures, WhatFliesFreelyKeepsEnergyAndMomentum) {
  const scenes::Scene scene = ball_into_free_sheet({});
  EXPECT_LT(energy_gained(scene, untouched(scene)), 1e-12);
  EXPECT_LT(momentum_changed(scene, untouched(scene)), 1e-15);
  EXPECT_GT(momentum_changed(scene, wrong_motion(scene, WrongMotion::kPushed)), 0.4);
}

TEST(MotionFigures, ARunThatEndedEarlyHasNoLateFigure) {
  for (const MotionScene& motion : judged_motions()) {
    MotionFrames frames = standing_still(motion.scene);
    frames.resize(3);
    for (const MotionFigure& figure : motion.figures) {
      if (figure.is_bound) continue;
      EXPECT_TRUE(std::isnan(figure.of(motion.scene, frames))) << figure.name;
    }
  }
}

TEST(MotionFigures, ExactStepsFitTheirFrames) {
  std::set<std::string> names;
  for (const MotionScene& motion : all_motions()) {
    const double steps = motion.scene.world.frame_interval / motion.exact_step;
    EXPECT_NEAR(steps, std::round(steps), 1e-6) << motion.scene.name;
    EXPECT_TRUE(names.insert(motion.scene.name).second) << motion.scene.name;
  }
}

}  // namespace
}  // namespace weft::validation
