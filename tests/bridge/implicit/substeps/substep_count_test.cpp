// Into how many substeps a step is divided that meets dynamic bodies.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <weft/bridge/implicit/substeps/explicit_substeps.hpp>
#include <weft/bridge/implicit/substeps/substep_count.hpp>
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

TEST(SubstepCount, FollowsPinsThatPullPressedCloth) {
  RigidEncounter encounter = kStill;
  encounter.pulled = btScalar(0.016);    // 1 m/s in 1/60 s
  EXPECT_EQ(substeps_of(encounter), 8);  // 2 mm in each
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
  SubstepCount substeps(btScalar(1.0), btScalar(0.2));
  EXPECT_EQ(substeps.count(10), 1);  // nothing is near any more
  substeps.include_nearby_body();
  EXPECT_EQ(substeps.count(10), 5);
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

// Two nodes of mass m on one spring swing at sqrt(2 k / m), and symplectic Euler is stable up to 2 over that.
TEST(SubstepCount, StableStepIsShorterThanThePeriodAllows) {
  fast::SpringNetwork network;
  network.edges.resize(2, 1);
  network.edges << 0, 1;
  network.rest_lengths = network.stiffness = network.compressed_stiffness =
      VectorX<double>::Ones(1);
  network.stiffness *= 200;
  network.damping = network.bending = VectorX<double>::Zero(1);
  const VectorX<double> masses = VectorX<double>::Constant(2, 0.01);
  const double longest = 2 / std::sqrt(2 * 200 / 0.01);
  EXPECT_NEAR(static_cast<double>(stable_step(network, masses)), 0.9 * longest, 1e-6 * longest);
  network.bending[0] = -600;  // what couples second neighbors may be negative
  EXPECT_NEAR(static_cast<double>(stable_step(network, masses)), 0.45 * longest, 1e-6 * longest);
  network.damping[0] = 1;
  EXPECT_EQ(stable_step(network, masses), 0);
  EXPECT_EQ(stable_step({}, masses), 0);
}

TEST(SubstepCount, SubstepsAreExplicitWhereThatCostsLittleMore) {
  const SubstepPlan cheap = plan_substeps(10, 1, btScalar(249.5));
  EXPECT_TRUE(cheap.is_explicit);
  EXPECT_EQ(cheap.count, 250);
  EXPECT_EQ(cheap.num_implicit, 10);
  const SubstepPlan dear = plan_substeps(10, 1, 400);
  EXPECT_FALSE(dear.is_explicit);
  EXPECT_EQ(dear.count, 10);
  EXPECT_TRUE(plan_substeps(10, 20, 400).is_explicit) << "an impact is resolved to its end";
  EXPECT_FALSE(plan_substeps(56, 56, std::numeric_limits<btScalar>::max()).is_explicit);
}

}  // namespace
}  // namespace weft::bridge
