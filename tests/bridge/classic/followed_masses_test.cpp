// Masses that a program changes after its laws are attached.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/deformable/deformable_world.hpp>
#include <weft/bridge/soft_world.hpp>

namespace weft::bridge {
namespace {

constexpr double kFollowedMassesTimeStep = 1.0 / 128;  // [s] exact in single precision
constexpr double kStiffness = 500.0;                   // [N/m]
const forces::LawSpecification kFollowedMassesGravity{
    "gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}};
const forces::LawSpecification kFollowedMassesSpring{"tension", {}, {{"stiffness", {kStiffness}}}};
const forces::LawSpecification kDrag{"velocity_damping", {}, {{"rate", {8.0}}}};

/// 1 m long, with 1 kg at each of its ends; the upper one is pinned.
ClothMesh pendulum() {
  ClothMesh mesh;
  mesh.rest_positions = Matrix3X<double>::Zero(3, 2);
  mesh.rest_positions(1, 1) = -1.0;
  mesh.triangles.resize(3, 0);
  Edges edge(2, 1);
  edge << 0, 1;
  mesh.edge_sets.push_back({"spring", edge});
  mesh.masses = VectorX<double>::Ones(2);
  mesh.pinned = {0};
  return mesh;
}

using Change = void (*)(btSoftBody&);
const Change kChanges[] = {[](btSoftBody& body) { body.setMass(1, 10); },
                           [](btSoftBody& body) { body.m_nodes[1].m_im = btScalar(0.1); },
                           [](btSoftBody& body) { body.setTotalMass(10); }};

double sag(SoftWorld& world, const btSoftBody& body, double time) {
  for (double t = 0; t < time; t += kFollowedMassesTimeStep) world.step(kFollowedMassesTimeStep);
  return -1.0 - static_cast<double>(body.m_nodes[1].m_x.y());
}

TEST(FollowedMasses, FastBodyHangsByItsPresentWeight) {
  for (const Change change : kChanges) {
    SoftWorld world({});
    btSoftBody& body = world.add(make_cloth_body(world.info(), pendulum(), {}));
    ASSERT_FALSE(world.solver().attach_fast(body, pendulum(),
                                            {kFollowedMassesSpring, kFollowedMassesGravity, kDrag},
                                            {.may_sleep = false}));
    EXPECT_NEAR(sag(world, body, 4), 9.81 / kStiffness, 1e-4);
    change(body);
    EXPECT_NEAR(sag(world, body, 4), 10 * 9.81 / kStiffness, 1e-3);
  }
}

// Bullet's gravity pulls by the mass that Bullet knows; the spring has to be solved for with the same.
TEST(FollowedMasses, FastBodyHangsByItsPresentWeightUnderBulletsGravity) {
  SoftWorld world({});
  world.info().m_gravity.setValue(0, btScalar(-9.81), 0);
  btSoftBody& body = world.add(make_cloth_body(world.info(), pendulum(), {}));
  ASSERT_FALSE(world.solver().attach_fast(body, pendulum(), {kFollowedMassesSpring, kDrag}));
  EXPECT_NEAR(sag(world, body, 6), 9.81 / kStiffness, 1e-3);  // asleep by then
  body.setMass(1, 10);
  EXPECT_NEAR(sag(world, body, 4), 10 * 9.81 / kStiffness, 2e-3);
}

TEST(FollowedMasses, ABodyFallsAsFastWithAnyMass) {
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), pendulum(), {}));
  world.solver().attach(body, pendulum(), {kFollowedMassesGravity});
  body.setMass(1, 10);
  world.step(kFollowedMassesTimeStep);
  EXPECT_NEAR(static_cast<double>(body.m_nodes[1].m_v.y()), -9.81 * kFollowedMassesTimeStep, 1e-4);
}

TEST(FollowedMasses, ABodyOfTheDeformableWorldToo) {
  DeformableWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), pendulum(), {}));
  world.forces().attach(body, pendulum(), {kFollowedMassesGravity});
  body.setMass(1, 10);
  world.step(kFollowedMassesTimeStep);
  EXPECT_NEAR(static_cast<double>(body.m_nodes[1].m_v.y()), -9.81 * kFollowedMassesTimeStep, 1e-4);
}

TEST(FollowedMasses, ANodeThatWasPinnedAndLetGoHasItsMassAgain) {
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), pendulum(), {}));
  world.solver().attach(body, pendulum(), {kFollowedMassesGravity});
  body.m_nodes[1].m_im = 0;
  world.step(kFollowedMassesTimeStep);
  EXPECT_EQ(body.m_nodes[1].m_v.y(), btScalar(0));
  body.m_nodes[1].m_im = btScalar(0.5);
  body.m_nodes[0].m_im = 1;
  world.step(kFollowedMassesTimeStep);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(static_cast<double>(body.m_nodes[i].m_v.y()), -9.81 * kFollowedMassesTimeStep, 1e-4)
        << i;
  }
}

TEST(FollowedMasses, AMassThatIsNoneIsReported) {
  for (const double inverse_mass : {std::nan(""), -1.0, std::numeric_limits<double>::infinity()}) {
    for (const bool is_fast : {false, true}) {
      SoftWorld world({});
      btSoftBody& body = world.add(make_cloth_body(world.info(), pendulum(), {}));
      if (is_fast) {
        ASSERT_FALSE(world.solver().attach_fast(body, pendulum(),
                                                {kFollowedMassesSpring, kFollowedMassesGravity}));
      } else {
        world.solver().attach(body, pendulum(), {kFollowedMassesGravity});
      }
      world.step(kFollowedMassesTimeStep);
      body.m_nodes[1].m_im = static_cast<btScalar>(inverse_mass);
      world.step(kFollowedMassesTimeStep);
      const auto blow_up = world.solver().blow_up(body);
      ASSERT_TRUE(blow_up) << inverse_mass;
      EXPECT_EQ(blow_up->node, 1);
      EXPECT_NE(blow_up->reason.find("m_im"), std::string::npos) << blow_up->reason;
      EXPECT_TRUE(std::isfinite(body.m_nodes[1].m_x.y()));
    }
  }
}

}  // namespace
}  // namespace weft::bridge
