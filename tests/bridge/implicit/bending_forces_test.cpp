// Bending stays with a body whatever a program does to its laws, its masses and its mesh.
#include <weft/bridge/implicit/bending_forces.hpp>

#include <gtest/gtest.h>

#include <weft/bridge/tearing.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

constexpr double kRigidity = 1e-3;  // [N m]
constexpr int kTip = 102;           // the middle of the last row
constexpr int kStepsToRest = 300;
/// What is left of a motion that halves six times a second, and rounding [m].
constexpr double kRest = 1e-4;

/// A strip of 4 by 20 cm that is clamped by its first two rows.
ClothMesh strip() {
  ClothGrid grid;
  grid.nodes = {5, 21};
  grid.size = {0.04, 0.2};
  grid.total_mass = 0.0016;
  ClothMesh mesh = make_cloth_grid(grid);
  for (int i = 0; i < 10; ++i) mesh.pinned.push_back(i);
  return mesh;
}

std::vector<forces::LawSpecification> laws(double rigidity) {
  return {kGravity, law("tension", "stiffness", 2000), law("velocity_damping", "rate", 4),
          law("hinge_torsion", "rigidity", rigidity)};
}

double droop(Scene& scene) {
  scene.step(kStepsToRest);
  return -scene.positions()(1, kTip);
}

double droop_of(const ClothMesh& mesh, double rigidity) {
  Scene scene(mesh, laws(rigidity));
  return droop(scene);
}

TEST(BendingForces, AreReplacedWithTheLaws) {
  const double stiff = droop_of(strip(), kRigidity);
  const double limp = droop_of(strip(), 0);
  ASSERT_GT(limp, stiff + 100 * kRest);
  Scene scene(strip(), laws(0));
  EXPECT_NEAR(droop(scene), limp, kRest);
  scene.solver().replace_laws(scene.body(), strip(), laws(kRigidity));
  EXPECT_NEAR(droop(scene), stiff, kRest);
  scene.solver().replace_laws(scene.body(), strip(), laws(0));
  EXPECT_NEAR(droop(scene), limp, kRest);
}

TEST(BendingForces, StayWithTornCloth) {
  Scene scene(strip(), laws(kRigidity));
  scene.step(60);
  ClothMesh torn = strip();
  const Blade lengthwise{{0, -0.5, -0.2}, {0, 0.5, -0.2}, {0, 0, 0.26}};
  ASSERT_FALSE(cut(scene.solver(), scene.body(), torn, {.collision_margin = kMargin},
                   laws(kRigidity), lengthwise)
                   .origins.empty());
  EXPECT_NEAR(droop(scene), droop_of(torn, kRigidity), kRest);
}

TEST(BendingForces, StayWithOtherMasses) {
  Scene scene(strip(), laws(kRigidity));
  scene.step(60);
  for (int i = 0; i < scene.body().m_nodes.size(); ++i) {
    if (scene.body().m_nodes[i].m_im > 0) scene.body().m_nodes[i].m_im /= 2;
  }
  ClothMesh heavy = strip();
  heavy.masses *= 2;
  EXPECT_NEAR(droop(scene), droop_of(heavy, kRigidity), kRest);
}

}  // namespace
}  // namespace weft::bridge
