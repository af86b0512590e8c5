// Bodies with implicit springs that meet each other.
#include <weft/bridge/contact/cloth_pairs.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <weft/bridge/adoption/adopting_solver.hpp>
#include <weft/bridge/contact/surface/outward_faces.hpp>

#include "tests/bridge/bullet_scenes.hpp"
#include "tests/bridge/rigid_objects.hpp"

namespace weft::bridge {
namespace {

using testing::PlainWorld;

constexpr double kStep = 1.0 / 60;  // [s]
constexpr double kMass = 20;        // [kg] of a ball
// The largest of all links [-].
constexpr double kStretchOfImpact = 0.6;  // at 8 m/s
constexpr double kStretchAtRest = 0.06;

/// A ball of 1 m in the manner of Bullet's demo: a closed surface with links over two.
btSoftBody& add_ball(PlainWorld& world, const btVector3& center) {
  btSoftBody* const ball =
      btSoftBodyHelpers::CreateEllipsoid(world.world.getWorldInfo(), center, vector(1, 1, 1), 150);
  ball->generateBendingConstraints(2);
  ball->m_cfg.piterations = 2;
  ball->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
  ball->getCollisionShape()->setMargin(btScalar(0.05));
  ball->setTotalMass(btScalar(kMass));  // nodes of equal masses
  return *world.add(ball);
}

void run(PlainWorld& world, int num_steps) {
  for (int step = 0; step < num_steps; ++step) {
    world.world.stepSimulation(static_cast<btScalar>(kStep), 0);
  }
}

double largest_stretch(const btSoftBody& body) {
  double most = 0;
  for (int l = 0; l < body.m_links.size(); ++l) {
    const btSoftBody::Link& link = body.m_links[l];
    if (link.m_bbending) continue;
    const btScalar length = (link.m_n[0]->m_x - link.m_n[1]->m_x).length();
    most = std::max(most, static_cast<double>(length / link.m_rl) - 1);
  }
  return most;
}

/// How many nodes of a body are inside a closed one, by the solid angle that its faces fill.
int num_inside(const btSoftBody& body, const btSoftBody& closed) {
  const std::vector<signed char> outward = outward_faces(closed);
  int num = 0;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    double angle = 0;
    for (int f = 0; f < closed.m_faces.size(); ++f) {
      const auto& n = closed.m_faces[f].m_n;
      const btVector3 a = n[0]->m_x - body.m_nodes[i].m_x;
      const btVector3 b = n[1]->m_x - body.m_nodes[i].m_x;
      const btVector3 c = n[2]->m_x - body.m_nodes[i].m_x;
      const btScalar la = a.length(), lb = b.length(), lc = c.length();
      angle += 2 * outward[static_cast<std::size_t>(f)] *
               std::atan2(static_cast<double>(btDot(a, btCross(b, c))),
                          static_cast<double>(la * lb * lc + btDot(a, b) * lc + btDot(b, c) * la +
                                              btDot(c, a) * lb));
    }
    if (std::abs(angle) > 2 * 3.14159) ++num;
  }
  return num;
}

// Contacts that only move nodes leave spikes at them of half an edge and more, and what gets in stays in.
TEST(ClothPairs, BodiesThatLieOnEachOtherKeepTheirShape) {
  AdoptingSolver solver;
  PlainWorld world(&solver);
  world.add_rigid(std::make_unique<btBoxShape>(vector(20, 1, 20)), 0, vector(0, -1, 0));
  btSoftBody& lower = add_ball(world, vector(0, 1.1, 0));
  // Bullet's helper draws the points of a ball alike each time: this one lies otherwise.
  btSoftBody& upper = add_ball(world, vector(0, 0, 0));
  upper.transform(
      btTransform(btQuaternion(btScalar(0.7), btScalar(0.3), 0), vector(0.2, 4.5, 0.1)));
  int num_met = 0;
  for (int step = 0; step < 180; ++step) {
    run(world, 1);
    num_met += lower.m_scontacts.size() + upper.m_scontacts.size() > 0 ? 1 : 0;
    ASSERT_LT(largest_stretch(lower), kStretchOfImpact) << step;
    ASSERT_LT(largest_stretch(upper), kStretchOfImpact) << step;
    ASSERT_EQ(num_inside(upper, lower) + num_inside(lower, upper), 0) << step;
  }
  EXPECT_GT(num_met, 10);  // in their last substeps
  EXPECT_LT(largest_stretch(lower), kStretchAtRest);
  EXPECT_LT(largest_stretch(upper), kStretchAtRest);
}

TEST(ClothPairs, GiveMomentumInTheSameStepAndGainNoEnergy) {
  AdoptingSolver solver;
  PlainWorld world(&solver);
  world.world.getWorldInfo().m_gravity.setZero();
  btSoftBody& thrown = add_ball(world, vector(-2.5, 0.3, 0));
  btSoftBody& hit = add_ball(world, vector(0, 0, 0));
  thrown.addVelocity(vector(5, 0, 0));
  const auto momentum = [&] {
    btVector3 sum(0, 0, 0);
    for (const btSoftBody* body : {&thrown, &hit}) {
      for (int i = 0; i < body->m_nodes.size(); ++i)
        sum += body->m_nodes[i].m_v / body->m_nodes[i].m_im;
    }
    return sum;
  };
  const auto energy = [&] {
    double sum = 0;
    for (const btSoftBody* body : {&thrown, &hit}) {
      for (int i = 0; i < body->m_nodes.size(); ++i)
        sum += static_cast<double>(body->m_nodes[i].m_v.length2() / body->m_nodes[i].m_im) / 2;
    }
    return sum;
  };
  const double start = kMass * 5;
  for (int step = 0; step < 60; ++step) {
    run(world, 1);
    ASSERT_NEAR(static_cast<double>(momentum().x()), start, 1e-3 * start) << step;
    ASSERT_LT(energy(), 1.01 * start * 5 / 2) << step;
  }
  double of_hit = 0;
  for (int i = 0; i < hit.m_nodes.size(); ++i) {
    of_hit += static_cast<double>(hit.m_nodes[i].m_v.x() / hit.m_nodes[i].m_im);
  }
  EXPECT_GT(of_hit, 0.4 * start);
}

}  // namespace
}  // namespace weft::bridge
