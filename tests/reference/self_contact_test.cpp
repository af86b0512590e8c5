// Cloth with itself and with other cloth: no layer ever passes through another one, as an
// independent count of edges through triangles sees it.
#include <cmath>

#include <gtest/gtest.h>

#include <weft/mesh/distance/continuous_distance.hpp>
#include <weft/reference/balance.hpp>
#include <weft/validation/metrics/distance/self_intersection.hpp>

#include "tests/reference/layer_runs.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;

TEST(ContinuousDistance, FindsAFastPassageThatNoEndShows) {
  FourPoints start, motion;
  start << 0.2, 0, 1, 0, 1.0, 0, 0, 0, 0.2, 0, 0, 1;
  motion.setZero();
  motion(1, 0) = -2000.0;  // through the triangle, to 1999 m behind it
  const auto hit = first_approach(PairKind::kPointTriangle, start, motion, 1e-4);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(*hit, 1.0 / 2000.0, 1e-7);
  motion(0, 0) = 4000.0;  // past its side
  EXPECT_FALSE(first_approach(PairKind::kPointTriangle, start, motion, 1e-4));
}

TEST(NearestEdges, AreNearestAtCrossingsEndsAndParallels) {
  FourPoints crossing;
  crossing << -1, 1, 0, 0, 0, 0, 0.3, 0.3, 0, 0, -1, 1;
  EXPECT_NEAR(nearest_edges(crossing).distance(), 0.3, 1e-15);
  FourPoints ends;
  ends << 0, 1, 2, 3, 0, 0, 1, 2, 0, 0, 0, 0;
  EXPECT_NEAR(nearest_edges(ends).distance(), std::sqrt(2.0), 1e-15);
  FourPoints parallel;
  parallel << 0, 1, 0.5, 3, 0, 0, 0.2, 0.2, 0, 0, 0, 0;
  EXPECT_NEAR(nearest_edges(parallel).distance(), 0.2, 1e-15);
}

Body layer(const std::string& name, double height, double speed) {
  Body body = make_cloth(5, 0.5, 0.1, height, 100.0, 0.05);
  body.name = name;
  body.velocities.row(1).setConstant(speed);
  body.mutual_contact = true;
  body.self_thickness = 0.01;
  body.friction = 0.5;
  return body;
}

TEST(MutualContact, ABulletFastLayerDoesNotPassThroughAnother) {
  for (const IntegratorKind integrator :
       {IntegratorKind::kModifiedEuler, IntegratorKind::kVelocityVerlet}) {
    System system;
    system.bodies.push_back(layer("below", 0.0, 0.0));
    system.bodies.push_back(layer("above", 0.1, -300.0));  // 0.3 m in a step
    for (int i = 0; i < 25; ++i) system.bodies[1].positions.col(i) += Vec(0.03, 0, 0.02);
    SpringSolver solver(std::move(system), {.integrator = integrator});
    const Vec momentum = linear_momentum(solver.system());
    for (int n = 0; n < 20; ++n) {
      const StepOutcome outcome = solver.step(1e-3);
      EXPECT_EQ(outcome.contact.num_stopped_nodes, 0) << name_of(integrator) << n;
      const Body& a = solver.system().bodies[0];
      const Body& b = solver.system().bodies[1];
      ASSERT_EQ(
          validation::count_piercings(a.positions, a.mesh.triangles, b.positions, b.mesh.triangles),
          0)
          << name_of(integrator) << ", step " << n;
    }
    EXPECT_LT((linear_momentum(solver.system()) - momentum).norm(), 1e-11 * momentum.norm());
  }
}

TEST(SelfContact, AFoldingDropNeverCrossesItself) {
  int stopped = 0;
  EXPECT_EQ(crossings_of_fold(folding_strip(5, true), 0.6, &stopped), 0);
  EXPECT_EQ(stopped, 0);
}

TEST(SelfContact, WithoutItTheSameDropCrossesItself) {
  EXPECT_GT(crossings_of_fold(folding_strip(5, false), 0.6, nullptr), 0);
}

TEST(SelfContact, ATwistedClothNeverCrossesItself) {
  int stopped = 0;
  EXPECT_EQ(crossings_of_twist(9, 1.5, true, &stopped), 0);
  EXPECT_EQ(stopped, 0);
}

TEST(SelfContact, WithoutItTheSameTwistCrossesItself) {
  EXPECT_GT(crossings_of_twist(9, 1.5, false, nullptr), 0);
}

}  // namespace
}  // namespace weft::reference::testing
