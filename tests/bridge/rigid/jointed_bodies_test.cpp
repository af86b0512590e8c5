// Rigid bodies on joints that fall on cloth.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <gtest/gtest.h>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

constexpr double kMassOfBox = 0.3;  // [kg]

constexpr double kEdge = 1.0;  // [m] of the sheet

/// A sheet that is pinned along its rim.
ClothMesh trampoline() {
  ClothMesh mesh = cloth(21, kEdge, 0, 0.2);
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    const Vector3<double> x = mesh.rest_positions.col(i);
    if (std::abs(x.x()) > 0.49 || std::abs(x.z()) > 0.49) mesh.pinned.push_back(i);
  }
  return mesh;
}

double energy_of_box(const btRigidBody& box) {
  const btVector3 turn = box.getAngularVelocity();
  const btScalar turning = turn.dot(box.getInvInertiaTensorWorld().inverse() * turn);
  return 0.5 * kMassOfBox * static_cast<double>(box.getLinearVelocity().length2()) +
         0.5 * static_cast<double>(turning) +
         kMassOfBox * 9.81 * static_cast<double>(box.getCenterOfMassPosition().y());
}

bool is_over_sheet(const btVector3& place) {
  return 2 * std::abs(static_cast<double>(place.x())) < kEdge &&
         2 * std::abs(static_cast<double>(place.z())) < kEdge;
}

class JointedBodies : public testing::TestWithParam<double> {};

// Three boxes on hinges that Bullet lists. They made 41 J of 8 at 4 m/s and 34 of 1.3 at 1 m/s, for what cloth did to their places
// was lost.
TEST_P(JointedBodies, GainNothingOnATrampoline) {
  const double velocity = GetParam();
  Scene scene(trampoline(), {kGravity, law("tension", "stiffness", 500)}, 0.5);
  std::array<btRigidBody*, 3> boxes{};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    boxes[i] = &scene.add(box(0.08, 0.03, 0.05), kMassOfBox,
                          at((static_cast<double>(i) - 1) * 0.18, 0.1, 0));
    boxes[i]->setLinearVelocity(vector(0, -velocity, 0));
  }
  std::vector<std::unique_ptr<btHingeConstraint>> hinges;
  for (std::size_t i = 0; i < 2; ++i) {
    hinges.push_back(std::make_unique<btHingeConstraint>(*boxes[i], *boxes[i + 1],
                                                         vector(0.09, 0, 0), vector(-0.09, 0, 0),
                                                         vector(0, 0, 1), vector(0, 0, 1)));
    scene.world().world().addConstraint(hinges.back().get(), true);
  }
  const auto energy = [&] {
    double sum = scene.mechanical_energy(0);
    for (const btRigidBody* one : boxes) sum += energy_of_box(*one);
    return sum;
  };
  const double first = energy();
  double most = first;
  double lowest = 0;
  for (int step = 0; step < 120; ++step) {
    scene.step();
    most = std::max(most, energy());
    // Folded up they may walk over the rim, and then they fall.
    for (const btRigidBody* one : boxes) {
      const btVector3& place = one->getCenterOfMassPosition();
      if (is_over_sheet(place)) lowest = std::min(lowest, static_cast<double>(place.y()));
    }
  }
  // While they are thrown back, energies are those of the middle of a step, and may read some percent too high.
  EXPECT_LT(most, 1.1 * first);
  EXPECT_LT(lowest, -0.05) << "they have fallen into it";
  EXPECT_GT(lowest, -0.2) << "and not through";
  for (const auto& hinge : hinges) scene.world().world().removeConstraint(hinge.get());
}

INSTANTIATE_TEST_SUITE_P(Velocities, JointedBodies, testing::Values(1.0, 4.0));

}  // namespace
}  // namespace weft::bridge
