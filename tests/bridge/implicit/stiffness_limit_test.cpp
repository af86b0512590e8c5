// Springs that are stiffer than a step can be solved for.
#include <vector>

#include <gtest/gtest.h>

#include <weft/bridge/implicit/stiffness_limit.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

TEST(StiffnessLimit, IsThatOfTheLighterNodeAndLeavesSofterSpringsAlone) {
  fast::SpringNetwork network;
  network.edges.resize(2, 2);
  network.edges << 0, 1, 1, 2;
  network.rest_lengths = VectorX<double>::Ones(2);
  network.stiffness.resize(2);
  network.stiffness << 1e30, 100.0;
  network.compressed_stiffness.resize(2);
  network.compressed_stiffness << 10.0, 100.0;
  network.damping.resize(2);
  network.damping << 0.5, 1e30;
  network.bending = VectorX<double>::Zero(2);
  VectorX<double> masses(3);
  masses << 2.0, 0.5, 8.0;
  const double step = 0.25;
  fast::SpringNetwork limited = network;
  EXPECT_TRUE(limit_stiffness(step, masses, limited));
  EXPECT_EQ(limited.stiffness[0], kMostStiffness * 0.5 / (step * step));
  EXPECT_EQ(limited.stiffness[1], 100.0);
  EXPECT_EQ(limited.compressed_stiffness, network.compressed_stiffness);
  EXPECT_EQ(limited.damping[0], 0.5);
  EXPECT_EQ(limited.damping[1], kMostStiffness * 0.5 / step);
  network = limited;
  EXPECT_FALSE(limit_stiffness(step, masses, limited));
  EXPECT_EQ(limited.stiffness, network.stiffness);
}

/// [m] of the far corner of a sheet that is held at one, after 0.25 s.
double fall(double stiffness, double step, int short_steps = 0) {
  ClothMesh mesh = cloth(15, 1, 0);
  mesh.pinned = {0};
  Scene scene(mesh, {kGravity, law("tension", "stiffness", stiffness)});
  constexpr double kShort = 1.0 / 2048;  // [s]
  scene.step(short_steps, kShort);
  scene.step(static_cast<int>((0.25 - short_steps * kShort) / step), step);
  return -scene.positions()(1, 224);
}

// A corner of a plate that turns about the other one falls farther than a free one, 0.31 m.
TEST(FastBody, FallsHoweverStiffItIs) {
  for (const double stiffness : {1e6, 1e8, 1e9, 1e10, 1e12}) {
    for (const double step : {1.0 / 60, 1.0 / 240}) {
      EXPECT_NEAR(fall(stiffness, step), 0.48, 0.05) << stiffness << " N/m, " << step << " s";
    }
    EXPECT_NEAR(fall(stiffness, 1.0 / 60, 32), 0.48, 0.06) << stiffness << " N/m, longer steps";
  }
}

}  // namespace
}  // namespace weft::bridge
