#include <weft/reference/statics/static_contact.hpp>

#include <gtest/gtest.h>

#include <weft/reference/contact/distance/signed_distance.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;
constexpr double kWeight = 0.3 * 9.81;  // [N]
constexpr double kMargin = 0.01;        // [m]

/// A cloth held at its corners that hangs on a ball.
System held_over_ball() {
  Body body = make_cloth(11, 1.0, 0.3, 0.0, 200.0, 0.0);
  add_law(body, "gravity", {{"acceleration", {0, -9.81, 0}}});
  add_law(body, "hinge_torsion", {{"rigidity", {1e-3}}});
  body.mesh.pinned = {0, 10, 110, 120};
  body.collision_margin = kMargin;
  System system = system_of(std::move(body));
  system.colliders.push_back(
      {.name = "ball", .shape = Sphere{0.3}, .position = {0.04, -0.3, 0.02}});
  return system;
}

TEST(StaticContact, CarriesTheWeightWithoutDepthToTheResidual) {
  System system = held_over_ball();
  Body& body = system.bodies[0];
  const StaticProblem problem = static_problem(body, kWeight);
  Matrix3X<double> positions = body.positions;
  const StaticContactOutcome outcome =
      solve_static_contact(problem, body, system.colliders, positions);
  ASSERT_TRUE(outcome.converged) << outcome.rounds << " rounds, depth " << outcome.depth
                                 << ", residual " << outcome.solution.residual;
  EXPECT_LE(outcome.solution.residual, 1e-10);
  Matrix3X<double> forces = Matrix3X<double>::Zero(3, positions.cols());
  problem.forces(positions, forces);
  int touching = 0;
  for (Eigen::Index node = 0; node < positions.cols(); ++node) {
    if (problem.fixed[static_cast<std::size_t>(node)]) continue;
    const Vec force = outcome.contact_forces.col(node);
    const SurfaceDistance surface = signed_distance(
        system.colliders[0].shape, {system.colliders[0].position, system.colliders[0].orientation},
        positions.col(node));
    EXPECT_GE(surface.distance, kMargin * (1 - kContactDepth));
    EXPECT_LT((forces.col(node) + force).norm(), 1.01e-10 * kWeight);
    if (force.isZero(0.0)) continue;
    ++touching;
    EXPECT_GT(force.dot(surface.normal), 0.0);
    EXPECT_LT(surface.normal.cross(force).norm(), 1e-12 * kWeight);  // no friction
    EXPECT_NEAR(surface.distance, kMargin, kContactDepth * kMargin);
  }
  EXPECT_GE(touching, 4);
}

TEST(StaticContact, IsWhereTheDynamicsComeToRest) {
  System system = held_over_ball();
  Body& body = system.bodies[0];
  const StaticProblem problem = static_problem(body, kWeight);
  Matrix3X<double> positions = body.positions;
  ASSERT_TRUE(solve_static_contact(problem, body, system.colliders, positions).converged);

  System moving = held_over_ball();
  add_law(moving.bodies[0], "velocity_damping", {{"rate", {6.0}}});
  add_law(moving.bodies[0], "spring_damping", {{"damping", {0.1}}});
  SpringSolver solver(std::move(moving), {.integrator = IntegratorKind::kModifiedEuler});
  const double h = 0.5 * solver.stability().stable_step;
  while (solver.time() < 6.0) (void)solver.step(h);
  // exp(-6 s x 3/s) = 1e-8 of 0.1 m is left, more of the slow gliding over the ball.
  EXPECT_LT((solver.system().bodies[0].positions - positions).cwiseAbs().maxCoeff(), 1e-5);
}

}  // namespace
}  // namespace weft::reference::testing
