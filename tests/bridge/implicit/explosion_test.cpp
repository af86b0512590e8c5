#include <gtest/gtest.h>

#include "bench/bullet/random_cloth.hpp"

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
  EXPECT_EQ(num_explosions(WEFT_NUM_CLOTHS, {}), 0);
}

// A light sheet that turns at 28 m/s and meets a sphere: planes of its far side have nodes' starts behind them.
TEST(Explosions, AFastNodeGainsNothingFromACurvedSurface) {
  const Explosion run = run_random_cloth(random_cloth(664), {});
  EXPECT_LT(run.energy_ratio, 1.1);
}

TEST(Explosions, AreNoticed) {
  // The same springs, explicit: four of five steps are too long for them.
  EXPECT_GT(num_explosions(40, {RandomClothSolver::Kind::kLaws}), 20);
}

}  // namespace
}  // namespace weft::bench
