// A cloth on an incline: which cells of a grid of friction and slope stick, how far a sticking one
// creeps and how fast a sliding one gets faster.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using Vec = Vector3<double>;
constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kMargin = 0.01;   // [m]
constexpr double kStep = 2e-3;     // [s]

SpringSolver cloth_on_incline(double friction, double slope, IntegratorKind integrator,
                              bool face_contact = false) {
  Body cloth = make_cloth(4, 0.3, 0.05, 0.0, 50.0, 0.02);
  add_law(cloth, "gravity", {{"acceleration", {0, -kGravity, 0}}});
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(slope, Vec::UnitZ()));  // falls towards -x
  for (int i = 0; i < cloth.mesh.num_nodes(); ++i) {
    const Vec flat = cloth.positions.col(i);
    cloth.positions.col(i) = turn * (flat + kMargin * Vec::UnitY());
  }
  cloth.collision_margin = kMargin;
  cloth.friction = friction;
  cloth.face_contact = face_contact;
  System system = system_of(std::move(cloth));
  // A plate in place of a plane where faces shall meet it.
  const Shape shape = face_contact ? Shape(Box{{20.0, 0.5, 2.0}}) : Shape(Plane{});
  system.colliders.push_back({.name = "incline", .shape = shape, .orientation = turn});
  if (face_contact) system.colliders[0].position = turn * Vec(0, -0.5, 0);
  return SpringSolver(std::move(system), {.integrator = integrator});
}

/// Mean speed downhill [m/s].
double speed(const SpringSolver& solver, double slope) {
  return Vec(-std::cos(slope), -std::sin(slope), 0)
      .dot(solver.system().bodies[0].velocities.rowwise().mean());
}

TEST(InclineGrid, EveryCellOf20x20SticksOrSlidesAsCoulombSays) {
  constexpr double kDuration = 0.2;  // [s]
  int sticking = 0;
  for (int i = 0; i < 20; ++i) {
    const double friction = 0.05 + 0.05 * i;
    for (int j = 0; j < 20; ++j) {
      const double slope = (1.3 + 2.4 * j) * M_PI / 180;  // 1.3 to 46.9 deg: never on the threshold
      SpringSolver solver = cloth_on_incline(friction, slope, IntegratorKind::kModifiedEuler);
      while (solver.time() < kDuration - 0.5 * kStep) (void)solver.step(kStep);
      const double expected =
          std::max(0.0, kGravity * (std::sin(slope) - friction * std::cos(slope))) * kDuration;
      const bool sticks = std::tan(slope) <= friction;
      sticking += sticks;
      const double found = speed(solver, slope);
      if (sticks) {
        EXPECT_LT(std::abs(found), 1e-6) << friction << " " << slope;
      } else {
        EXPECT_NEAR(found, expected, 0.02 * expected) << friction << " " << slope;
      }
    }
  }
  EXPECT_GT(sticking, 100);
  EXPECT_LT(sticking, 300);
}

TEST(InclineGrid, JustBelowTheThresholdNothingCreepsAndJustAboveItSlides) {
  for (const bool face_contact : {false, true}) {
    for (const IntegratorKind integrator :
         {IntegratorKind::kModifiedEuler, IntegratorKind::kVelocityVerlet, IntegratorKind::kTrBdf2,
          IntegratorKind::kImplicitEuler}) {
      for (const double friction : {0.1, 0.5, 1.0}) {
        const double below = std::atan(0.99 * friction);
        SpringSolver solver = cloth_on_incline(friction, below, integrator, face_contact);
        const Matrix3X<double> start = solver.system().bodies[0].positions;
        for (int n = 0; n < 500; ++n) (void)solver.step(kStep);
        const Matrix3X<double> moved = solver.system().bodies[0].positions - start;
        const double creep =
            std::sqrt(moved.colwise().squaredNorm().maxCoeff()) / solver.time();  // [m/s]
        EXPECT_LT(creep, 1e-6) << name_of(integrator) << " " << friction << face_contact;

        const double above = std::atan(1.05 * friction);
        SpringSolver sliding = cloth_on_incline(friction, above, integrator, face_contact);
        for (int n = 0; n < 200; ++n) (void)sliding.step(kStep);
        const double acceleration = kGravity * (std::sin(above) - friction * std::cos(above));
        EXPECT_NEAR(speed(sliding, above) / sliding.time(), acceleration, 0.02 * acceleration)
            << name_of(integrator) << " " << friction << face_contact;
      }
    }
  }
}

}  // namespace
}  // namespace weft::reference::testing
