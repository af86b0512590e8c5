#include <gtest/gtest.h>

#include "bench/bullet/workloads/random_cloth.hpp"
#include "tests/support/count.hpp"

namespace weft::bench {
namespace {

int num_explosions(int num_cloths, const RandomClothSolver& solver) {
  int count = 0;
  for (int i = 0; i < num_cloths; ++i) {
    const Explosion explosion = run_random_cloth(random_cloth(i), solver);
    if (explosion.any()) ++count;
    if (solver.kind == RandomClothSolver::Kind::kFast) {
      EXPECT_FALSE(explosion.any()) << "cloth " << i << ": " << explosion.energy_ratio
                                    << " times the energy, " << explosion.fastest << " m/s";
    }
  }
  return count;
}

// A slow test of its own goes through all 1000 (explosions.csv has what Bullet's links make of them).
TEST(Explosions, NoneOfRandomClothsExplodes) {
  EXPECT_EQ(num_explosions(test::count(60), {}), 0);
}

// A light sheet that turns at 28 m/s and meets a sphere: planes of its far side have nodes' starts behind them.
TEST(Explosions, AFastNodeGainsNothingFromACurvedSurface) {
  const Explosion run = run_random_cloth(random_cloth(664), {});
  EXPECT_LT(run.energy_ratio, 1.1);
}

// A corner is pulled in between its neighbors by seventy times the weight: for some ten iterations each gains as much as the one
// before, which is no rounding. Steps that ended there had 2350 and 2.6 times the energy.
TEST(Explosions, SlowConvergenceIsNotTakenForRounding) {
  for (const int number : {8339, 9710}) {
    EXPECT_LT(run_random_cloth(random_cloth(number), {}).energy_ratio, 1.1) << number;
  }
}

TEST(Explosions, AreNoticed) {
  // The same springs, explicit: four of five steps are too long for them.
  EXPECT_GT(num_explosions(40, {RandomClothSolver::Kind::kLaws}), 20);
}

}  // namespace
}  // namespace weft::bench
