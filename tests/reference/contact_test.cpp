#include <cmath>

#include <gtest/gtest.h>

#include <weft/reference/contact/contact_problem.hpp>
#include <weft/reference/contact/distance/signed_distance.hpp>

#include "tests/reference/fixed_numbers.hpp"
#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;

constexpr double kGravity = 9.81;  // [m/s^2]

Eigen::Quaterniond some_rotation() {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vec(1, -2, 3).normalized()));
}

// ---- signed distance

/// Distance to the nearest of a dense grid of surface points; never too small, and too large by at
/// most the distance from a surface point to its nearest grid point.
double brute_force_distance(const Box& box, const Vec& point_body, int samples) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i <= samples; ++i) {
        for (int j = 0; j <= samples; ++j) {
          Vec surface;
          surface[axis] = side;
          surface[(axis + 1) % 3] = 2.0 * i / samples - 1.0;
          surface[(axis + 2) % 3] = 2.0 * j / samples - 1.0;
          surface = surface.cwiseProduct(box.half_extents);
          nearest = std::min(nearest, (surface - point_body).norm());
        }
      }
    }
  }
  return nearest;
}

TEST(SignedDistance, OfABoxEqualsBruteForceSampling) {
  const Box box{{0.4, 0.7, 1.1}};
  const Pose pose{{0.3, -0.2, 0.5}, some_rotation()};
  constexpr int kSamples = 60;
  // Half the diagonal of the largest grid cell.
  const double spacing = 0.5 * std::hypot(2 * 0.7 / kSamples, 2 * 1.1 / kSamples);
  Numbers numbers;
  int num_inside = 0;
  for (int n = 0; n < 200; ++n) {
    const Vec point_body = 1.6 * numbers.vector();
    const bool inside = (point_body.cwiseAbs() - box.half_extents).maxCoeff() < 0;
    num_inside += inside;
    const Vec point = pose.position + pose.orientation * point_body;
    const double distance = signed_distance(box, pose, point).distance;
    const double brute = brute_force_distance(box, point_body, kSamples);
    EXPECT_EQ(distance < 0, inside);
    EXPECT_LE(std::abs(distance), brute + 16 * kEpsilon);
    EXPECT_GE(std::abs(distance), brute - spacing);
  }
  EXPECT_GT(num_inside, 5);
}

TEST(SignedDistance, NormalIsItsUnitGradientAndLeadsToTheSurface) {
  const Pose pose{{0.3, -0.2, 0.5}, some_rotation()};
  const Shape shapes[] = {Sphere{0.6}, Box{{0.4, 0.7, 1.1}}, Plane{}};
  Numbers numbers;
  for (const Shape& shape : shapes) {
    for (int n = 0; n < 300; ++n) {
      const Vec point = pose.position + 1.6 * numbers.vector();
      const SurfaceDistance at = signed_distance(shape, pose, point);
      EXPECT_NEAR(at.normal.norm(), 1.0, 8 * kEpsilon);
      const Vec foot = point - at.distance * at.normal;
      EXPECT_NEAR(signed_distance(shape, pose, foot).distance, 0.0, 32 * kEpsilon);
      // Convexity, on which the contact stages rely.
      const Vec other = point + 0.5 * numbers.vector();
      EXPECT_GE(signed_distance(shape, pose, other).distance,
                at.distance + at.normal.dot(other - point) - 32 * kEpsilon);
    }
  }
}

TEST(SignedDistance, OfABoxAtFaceEdgeAndCorner) {
  const Box box{{1, 2, 3}};
  const Pose pose{Vec::Zero(), Eigen::Quaterniond::Identity()};
  EXPECT_DOUBLE_EQ(signed_distance(box, pose, {0.5, -2.5, 1}).distance, 0.5);
  EXPECT_DOUBLE_EQ(signed_distance(box, pose, {4, 6, 0}).distance, 5);
  EXPECT_DOUBLE_EQ(signed_distance(box, pose, {-3, 3, 5}).distance, 3);
  EXPECT_DOUBLE_EQ(signed_distance(box, pose, {0.9, 0, 0}).distance, 0.9 - 1);
  EXPECT_EQ(signed_distance(box, pose, {-0.9, 0, 0}).normal, Vec(-1, 0, 0));
}

// ---- Coulomb's law on its own

ContactProblem crowded_problem(double friction) {
  ContactProblem problem;
  Numbers numbers;
  problem.rigids.push_back({.inverse_mass = 1 / 0.8,
                            .inverse_inertia = Vec(9, 14, 20).asDiagonal(),
                            .velocity = {0, -2, 0},
                            .angular_velocity = {1, 4, -3}});
  problem.rigids.push_back({});
  for (int i = 0; i < 12; ++i) {
    problem.points.push_back(
        {.node = i, .inverse_mass = 10.0 + 5 * i, .velocity = numbers.vector()});
    const Vec normal = (Vec(0, -1, 0) + 0.6 * numbers.vector()).normalized();
    problem.contacts.push_back({.on = {.points = {i, -1, -1, -1}},
                                .rigid = 0,
                                .normal = normal,
                                .lever = 0.4 * normal + 0.1 * numbers.vector(),
                                .target_speed = 0.1 * numbers.next(),
                                .friction = friction});
    if (i % 3 == 0) {
      problem.contacts.push_back(
          {.on = {.points = {i, -1, -1, -1}}, .rigid = 1, .friction = 0.5 * friction});
    }
  }
  return problem;
}

TEST(CoulombContacts, SolutionObeysSignoriniAndCoulombExactly) {
  // Converged to kSweepTolerance per sweep; sweeps shrink the error by 1e-3 of itself or more.
  constexpr double kTolerance = 1e4 * kSweepTolerance;
  int num_sticking = 0, num_slipping = 0, num_open = 0;
  for (const double friction : {0.0, 0.1, 0.4, 1.0}) {
    ContactProblem problem = crowded_problem(friction);
    const SweepReport report = solve_contacts(problem);
    ASSERT_TRUE(report.converged) << report.sweeps;
    for (const Contact& contact : problem.contacts) {
      const Vec velocity = relative_velocity(problem, contact);
      const double speed = contact.normal.dot(velocity);
      const double push = contact.normal.dot(contact.impulse);
      const Vec slip = velocity - speed * contact.normal;
      const Vec drag = contact.impulse - push * contact.normal;
      EXPECT_GE(push, -kTolerance);
      EXPECT_GE(speed, contact.target_speed - kTolerance);
      EXPECT_NEAR(push * (speed - contact.target_speed), 0.0, kTolerance);
      const double limit = contact.friction * push;
      EXPECT_LE(drag.norm(), limit + kTolerance);
      if (push <= kTolerance) {
        ++num_open;
      } else if (slip.norm() <= kTolerance) {
        ++num_sticking;
      } else {
        ++num_slipping;
        EXPECT_NEAR(drag.norm(), limit, kTolerance);
        EXPECT_NEAR(drag.dot(slip), -drag.norm() * slip.norm(), kTolerance);
      }
    }
  }
  EXPECT_GT(num_sticking, 0);
  EXPECT_GT(num_slipping, 0);
  EXPECT_GT(num_open, 0);
}

constexpr double kMargin = 0.02;  // [m]

// ---- weight, penetration

TEST(RestingCloth, NormalImpulsesCarryItsWeight) {
  constexpr double kMass = 0.3, kStep = 0.002;
  for (const ContactKind contact : {ContactKind::kProjection, ContactKind::kImpulse}) {
    for (const IntegratorKind integrator : kAllIntegrators) {
      Body cloth = make_cloth(5, 0.4, kMass, kMargin, 100.0, 0.2);
      add_law(cloth, "gravity", {{"acceleration", {0, -kGravity, 0}}});
      cloth.collision_margin = kMargin;
      cloth.friction = 0.5;
      System system = system_of(std::move(cloth));
      system.colliders.push_back({.name = "floor", .shape = Plane{}});
      SpringSolver solver(std::move(system), {.integrator = integrator, .contact = contact});
      for (int n = 0; n < 100; ++n) {
        const StepOutcome outcome = solver.step(kStep);
        ASSERT_EQ(outcome.contact.num_contacts, 25);
        EXPECT_NEAR(outcome.contact.normal_impulse / kStep, kMass * kGravity,
                    1e3 * kEpsilon * kMass * kGravity)
            << name_of(integrator);  // round-off of 25 contacts
      }
    }
  }
}

System drape(const Shape& shape, const Eigen::Quaterniond& orientation) {
  Body cloth = make_cloth(9, 1.0, 0.2, 0.45, 60.0, 0.05);
  add_law(cloth, "gravity", {{"acceleration", {0, -kGravity, 0}}});
  add_law(cloth, "velocity_damping", {{"rate", {0.5}}});
  cloth.collision_margin = kMargin;
  cloth.friction = 0.3;
  System system = system_of(std::move(cloth));
  Collider collider{.name = "collider", .shape = shape};
  collider.orientation = orientation;
  system.colliders.push_back(collider);
  Collider floor{.name = "floor", .shape = Plane{}, .position = {0, -0.3, 0}};
  system.colliders.push_back(floor);
  return system;
}

TEST(Drape, NoNodeEndsAStepInside) {
  for (const ContactKind contact : {ContactKind::kProjection, ContactKind::kImpulse}) {
    for (const IntegratorKind integrator :
         {IntegratorKind::kModifiedEuler, IntegratorKind::kVelocityVerlet,
          IntegratorKind::kRungeKutta4}) {
      for (const Shape& shape : {Shape(Sphere{0.3}), Shape(Box{{0.3, 0.2, 0.25}})}) {
        SpringSolver solver(drape(shape, some_rotation()),
                            {.integrator = integrator, .contact = contact});
        double deepest = 0.0;
        int num_contacts = 0;
        for (int n = 0; n < 400; ++n) {
          const StepOutcome outcome = solver.step(0.002);
          ASSERT_FALSE(outcome.blow_up);
          num_contacts = std::max(num_contacts, outcome.contact.num_contacts);
          const Body& cloth = solver.system().bodies[0];
          for (const Collider& collider : solver.system().colliders) {
            for (int i = 0; i < cloth.mesh.num_nodes(); ++i) {
              const Pose pose{collider.position, collider.orientation};
              const double distance =
                  signed_distance(collider.shape, pose, cloth.positions.col(i)).distance;
              deepest = std::max(deepest, kMargin - distance);
            }
          }
        }
        EXPECT_GT(num_contacts, 10);
        EXPECT_LT(deepest, 1e-12) << name_of(integrator);  // round-off of metres
      }
    }
  }
}

TEST(Projection, MovesAlongTheNormalAndRemovesTheInwardVelocityOnly) {
  System system = system_of(make_free_node(0.2, {0, 0.4, 0}, Vec::Zero()));
  system.colliders.push_back({.name = "ball", .shape = Sphere{0.5}});
  system.bodies[0].collision_margin = 0.1;
  system.bodies[0].friction = 5.0;  // projection has no friction
  system.bodies[0].velocities.col(0) << 1.0, -2.0, 0.0;
  SpringSolver solver(std::move(system), {.contact = ContactKind::kProjection});
  constexpr double kStep = 0.01;
  (void)solver.step(kStep);
  const Vec entered = Vec(0, 0.4, 0) + kStep * Vec(1, -2, 0);
  const Vec normal = entered.normalized();
  const Vec velocity = Vec(1, -2, 0) - normal.dot(Vec(1, -2, 0)) * normal;
  const Body& node = solver.system().bodies[0];
  EXPECT_LT((node.positions.col(0) - 0.6 * normal).norm(), 8 * kEpsilon);
  EXPECT_LT((node.velocities.col(0) - velocity).norm(), 16 * kEpsilon);
}

}  // namespace
}  // namespace weft::reference::testing
