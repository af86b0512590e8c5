#include <weft/validation/cases/engines/work_precision.hpp>

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::validation {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ParetoFront, HoldsWhatNothingBeatsInBothNumbers) {
  //                               0    1    2    3    4
  const std::vector<double> work{1.0, 2.0, 3.0, 4.0, 2.5};
  const std::vector<double> error{9.0, 5.0, 6.0, 1.0, 5.0};
  EXPECT_THAT(pareto_front(work, error), ElementsAre(0, 1, 3));
}

TEST(ParetoFront, LeavesOutWhatCannotBeDrawn) {
  const double nan = std::nan("");
  EXPECT_THAT(pareto_front({nan, 1.0, 2.0, 0.0}, {1.0, nan, 3.0, 1.0}), ElementsAre(2));
  EXPECT_THAT(pareto_front({}, {}), IsEmpty());
}

TEST(ParetoFront, OfEqualWorkTheNearerIsOnIt) {
  EXPECT_THAT(pareto_front({1.0, 1.0}, {2.0, 1.0}), ElementsAre(1));
}

TEST(WorkStudies, EveryRunHasALabelOfItsOwnAndWholeStepsPerFrame) {
  for (const WorkStudy& study : work_studies()) {
    std::set<std::string> labels;
    std::vector<WorkRun> runs = work_runs(study, true);
    for (const WorkRun& run : converged_runs(study)) runs.push_back(run);
    for (const WorkRun& run : runs) {
      EXPECT_TRUE(labels.insert(run.label(study.scene)).second) << run.label(study.scene);
      const scenes::World world = work_scene(study, run).world;
      // Bullet rounds the step to single precision; the frames follow it exactly.
      EXPECT_EQ(world.frame_interval, run.steps_per_frame * world.time_step);
    }
  }
}

TEST(WorkStudies, BulletSoftHasThreeStepsTimesFiveIterations) {
  std::set<std::pair<int, int>> settings;
  for (const WorkRun& run : work_runs(work_studies().front(), true)) {
    if (run.engine.engine == "bullet_soft") settings.insert({run.steps_per_frame, run.iterations});
  }
  EXPECT_EQ(settings.size(), 15U);
}

}  // namespace
}  // namespace weft::validation
