// A box that swings on two anchors, turns over and is flung about, wrapped in the cloth: chaos, so that it is let go
// eight times (480 in the slow test), each a little heavier than the one before.
#include <algorithm>
#include <cmath>
#include <iostream>

#include "tests/bridge/fast_scene.hpp"
#include "tests/support/count.hpp"

namespace weft::bridge {
namespace {

constexpr double kMass = 2;  // [kg]

/// The extremes of ten seconds.
struct Extremes {
  double energy = -1;  ///< beyond that of the start [J]
  double gap = 0;      ///< between an anchor and its node [m]
};

Extremes extremes_of(int number) {
  ClothMesh mesh = cloth(9, 1, 2);
  mesh.pinned = {0, 8};
  Scene scene(mesh,
              {kGravity, law("tension", "stiffness", 2000), law("velocity_damping", "rate", 3)});
  btRigidBody& load = scene.add(box(0.5, 0.1, 0.1), kMass + 1e-4 * number, at(0, 2, -0.5));
  scene.body().appendAnchor(72, &load, false, 1);
  scene.body().appendAnchor(80, &load, false, 1);
  Extremes most;
  for (int i = 0; i < 40; ++i) {
    scene.step(15);
    const double energy =
        kMass / 2 * static_cast<double>(load.getLinearVelocity().length2()) +
        kMass * 9.81 * static_cast<double>(load.getCenterOfMassPosition().y() - 2) +
        scene.mechanical_energy(2);
    most.energy = std::max(most.energy, energy);
    for (int a = 0; a < 2; ++a) {
      const btSoftBody::Anchor& anchor = scene.body().m_anchors[a];
      const btVector3 place = load.getWorldTransform() * anchor.m_local;
      most.gap = std::max(most.gap, static_cast<double>((anchor.m_node->m_x - place).length()));
    }
  }
  EXPECT_FALSE(scene.solver().blow_up(scene.body()));
  // What it may have fallen from its start by then is no more than 0.5 m.
  EXPECT_LT(load.getLinearVelocity().length(), std::sqrt(2 * 9.81 * 0.5)) << number;
  EXPECT_GT(load.getCenterOfMassPosition().y(), 0.5) << number;
  return most;
}

TEST(FastBody, HoldsABoxOnAnchors) {
  const int num_boxes = test::count(8);
  int num_gains = 0;
  Extremes most;
  for (int k = 0; k < num_boxes; ++k) {
    const Extremes of_box = extremes_of(k);
    num_gains += of_box.energy > 0.5 ? 1 : 0;
    most.energy = std::max(most.energy, of_box.energy);
    most.gap = std::max(most.gap, of_box.gap);
  }
  std::cout << num_boxes << " boxes: " << num_gains << " gain energy, most " << most.energy
            << " J; largest gap " << most.gap << " m\n";
  // None of 480 does. An anchor leads to first order in the turn of a step, the box is turned by all of it.
  EXPECT_EQ(num_gains, 0);
  // Without any turn eight boxes have a gap of 1 cm, with it of 1.3 mm; 480 of 1.1 cm in some flinging.
  EXPECT_LT(most.gap, num_boxes > 100 ? 0.02 : 0.004);
}

}  // namespace
}  // namespace weft::bridge
