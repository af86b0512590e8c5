// Into how many substeps a step is divided that meets dynamic bodies.
#include <cmath>

#include <gtest/gtest.h>

#include <weft/bridge/implicit/substep_count.hpp>
#include <weft/fast_solver/network/spring_network.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

/// A ball of 10 cm, over which waves come in a tenth of the step, and which cloth of its mass does not move.
constexpr RigidEncounter kStill{btScalar(0.1), 0, 0, 0, btScalar(0.003), btScalar(5)};

int substeps_of(const RigidEncounter& encounter, int last = 1) {
  SubstepCount substeps(btScalar(1.0), btScalar(0.2));
  substeps.include(encounter);
  return substeps.count(last);
}

TEST(SubstepCount, IsOneForWhatLiesThere) {
  EXPECT_EQ(SubstepCount(btScalar(1.0), btScalar(0.2)).count(1), 1);
  RigidEncounter encounter = kStill;
  encounter.pushed = encounter.fall;
  encounter.closing = encounter.fall;
  EXPECT_EQ(substeps_of(encounter), 1);
}

TEST(SubstepCount, FollowsASurfaceThatComesFar) {
  RigidEncounter encounter = kStill;
  encounter.inverse_mass = 0;  // a heavy body
  encounter.closing = encounter.approach = btScalar(0.055);
  EXPECT_EQ(substeps_of(encounter), 3);  // 0.2 of 0.1 m in each
}

TEST(SubstepCount, ResolvesTheWavesOfAnImpact) {
  RigidEncounter encounter = kStill;
  encounter.closing = btScalar(0.05);
  EXPECT_EQ(substeps_of(encounter), 10);
  encounter.closing = 0;
  encounter.pushed = btScalar(0.01);
  EXPECT_EQ(substeps_of(encounter), 10);
}

TEST(SubstepCount, IsNoGreaterForABodyThatClothCannotStop) {
  RigidEncounter encounter = kStill;
  encounter.closing = btScalar(0.05);
  encounter.inverse_mass = btScalar(0.05);
  EXPECT_EQ(substeps_of(encounter), 1);
}

TEST(SubstepCount, DecreasesByHalfAndIsLimited) {
  EXPECT_EQ(substeps_of(kStill, 10), 5);
  EXPECT_EQ(SubstepCount(btScalar(1.0), btScalar(0.2)).count(10), 1);  // nothing is met any more
  RigidEncounter encounter = kStill;
  encounter.closing = 1000;
  encounter.approach = 1000;
  EXPECT_EQ(substeps_of(encounter), SubstepCount::kMost);
}

// The 24-neighbor grid has E = 12.8 k and nu = 0.488, so that C = E / (1 - nu^2).
TEST(SubstepCount, WaveSpeedIsThatOfTheGridsModuli) {
  const ClothMesh mesh = cloth(41, 1, 0, 0.2);
  const VectorX<double> masses = mesh.masses;
  const double speed = static_cast<double>(
      wave_speed(fast::make_network(mesh, {law("tension", "stiffness", 2000)}), masses));
  EXPECT_NEAR(speed, std::sqrt(12.8 / (1 - 0.488 * 0.488) * 2000 / 0.2), 0.05 * speed);
  EXPECT_EQ(wave_speed({}, masses), 0);
  EXPECT_EQ(wave_speed({}, {}), 0);
}

}  // namespace
}  // namespace weft::bridge
