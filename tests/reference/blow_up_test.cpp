#include <cmath>

#include <gtest/gtest.h>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;

System ball_over_cloth(const Vec& velocity, const Vec& angular_velocity) {
  System system = system_of(make_cloth(4, 1.0, 0.1, 0.0, 10.0, 0.0));
  Collider ball{.name = "ball", .shape = Box{{0.1, 0.2, 0.3}}, .position = {0, 1, 0}};
  ball.mass = 1.0;
  ball.velocity = velocity;
  ball.angular_velocity = angular_velocity;
  system.colliders.push_back(ball);
  return system;
}

TEST(RigidBlowUp, IsFoundInTheAngularVelocity) {
  for (const double speed : {2e6, 1e200, std::nan("")}) {
    for (const IntegratorKind integrator : kAllIntegrators) {
      SpringSolver solver(ball_over_cloth(Vec::Zero(), {0, speed, 0}), {.integrator = integrator});
      const StepOutcome outcome = solver.step(0.001);
      ASSERT_TRUE(outcome.blow_up) << speed;
      EXPECT_EQ(outcome.blow_up->body, "ball");
      EXPECT_NE(outcome.blow_up->reason.find("angular"), std::string::npos);
      // The run ends with the state in which it was found: nothing was made of it.
      EXPECT_TRUE(solver.system().colliders[0].orientation.coeffs().allFinite());
      EXPECT_TRUE(solver.system().bodies[0].positions.allFinite());
    }
  }
}

TEST(RigidBlowUp, OfAPushIsFoundBeforeContact) {
  SpringSolver solver(ball_over_cloth(Vec::Zero(), Vec::Zero()));
  solver.push_collider(0, Vec::Zero(), {0, 1e250, 0}, 0.001);
  const StepOutcome outcome = solver.step(0.001);
  ASSERT_TRUE(outcome.blow_up);
  EXPECT_EQ(outcome.blow_up->body, "ball");
  EXPECT_EQ(outcome.contact.passes, 0);
}

TEST(ClothBlowUp, IsFoundBeforeContact) {
  System system = ball_over_cloth(Vec::Zero(), Vec::Zero());
  system.bodies[0].external_forces = Matrix3X<double>::Constant(3, 16, -1e30);
  SpringSolver solver(std::move(system));
  const StepOutcome outcome = solver.step(0.001);
  ASSERT_TRUE(outcome.blow_up);
  EXPECT_EQ(outcome.blow_up->body, "cloth");
  EXPECT_EQ(outcome.contact.passes, 0);
  EXPECT_EQ(outcome.contact.num_contacts, 0);
}

}  // namespace
}  // namespace weft::reference::testing
