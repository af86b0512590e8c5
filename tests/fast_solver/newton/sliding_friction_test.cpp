// Tested: sheets that slide do so as Coulomb's law says, in steps that end solved.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <weft/fast_solver/implicit_solver.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::fast {
namespace {

constexpr double kWeight = 9.81;  // [m/s^2]

/// A square sheet that lies on the plane y = 0.
template <class Scalar>
class SlidingSheet {
 public:
  SlidingSheet(int nodes, double size, double mass, double stiffness, double friction)
      : mesh_(mesh(nodes, size, mass)),
        solver_(make_network(mesh_, {{"tension", {}, {{"stiffness", {stiffness}}}}}), mesh_.masses,
                std::vector<bool>(static_cast<std::size_t>(mesh_.num_nodes()), true)),
        positions_(mesh_.rest_positions.cast<Scalar>()),
        velocities_(Matrix3X<Scalar>::Zero(3, mesh_.num_nodes())) {
    positions_.row(1).setZero();
    for (int i = 0; i < mesh_.num_nodes(); ++i) {
      PlaneContact<Scalar> contact;
      contact.node = i;
      contact.normal = {0, 1, 0};
      contact.friction = static_cast<Scalar>(friction);
      contacts_.push_back(contact);
    }
  }

  /// Returns whether the step was solved. gravity: along x and y [m/s^2].
  bool step(double time_step, double along, double down) {
    const auto h = static_cast<Scalar>(time_step);
    // Without forces, as the bridge foretells positions.
    Matrix3X<Scalar> x = positions_ + h * velocities_;
    Matrix3X<Scalar> y = x;
    y.row(0).array() += static_cast<Scalar>(along) * h * h;
    y.row(1).array() -= static_cast<Scalar>(down) * h * h;
    solver_.solve({y, positions_, h, h, contacts_}, {}, x);
    velocities_ = (x - positions_) / h;
    positions_ = x;
    return solver_.report().is_converged;
  }

  [[nodiscard]] Matrix3X<Scalar>& velocities() { return velocities_; }
  [[nodiscard]] double velocity_along() const {
    return static_cast<double>(velocities_.row(0).mean());
  }

 private:
  static ClothMesh mesh(int nodes, double size, double mass) {
    ClothGrid grid;
    grid.nodes = {nodes, nodes};
    grid.size = {size, size};
    grid.v_axis = {0, 0, 1};
    grid.total_mass = mass;
    return make_cloth_grid(grid);
  }
  ClothMesh mesh_;
  ImplicitSolver<Scalar> solver_;
  Matrix3X<Scalar> positions_;
  Matrix3X<Scalar> velocities_;
  std::vector<PlaneContact<Scalar>> contacts_;
};

// A decision on contact states gives friction other bounds, which change the energy without any motion. The sheet is bumpy: its
// nodes press on the floor more or less from step to step.
TEST(SlidingFriction, LeavesFewStepsUnsolved) {
  constexpr int kSteps = 100;
  SlidingSheet<float> sheet(4, 2, 20, 1e5, 0.2);
  for (Eigen::Index i = 0; i < sheet.velocities().cols(); ++i) {
    sheet.velocities().col(i) << 5, static_cast<float>(i % 3) - 1, 0;
  }
  int num_unsolved = 0;
  for (int i = 0; i < kSteps; ++i) num_unsolved += sheet.step(1.0 / 60, 0, kWeight) ? 0 : 1;
  EXPECT_LE(num_unsolved, kSteps / 50);
}

// On a slope that is hardly steeper than its friction bears, from rest: little is left of two large forces. Errors of all steps
// have one sign, and may be within the tolerance of each.
TEST(SlidingFriction, AcceleratesASheetFromRestAsCoulombSays) {
  constexpr double kFriction = 0.45;
  for (const double time_step : {1e-3, 1.0 / 240, 1.0 / 60}) {
    for (const double steeper : {1.01, 1.1, 2.0}) {
      const double angle = std::atan(kFriction * steeper);
      const double along = kWeight * std::sin(angle), down = kWeight * std::cos(angle);
      SlidingSheet<double> sheet(3, 0.2, 0.01, 10, kFriction);
      const int num_steps = static_cast<int>(std::lround(0.5 / time_step));
      for (int i = 0; i < num_steps; ++i) (void)sheet.step(time_step, along, down);
      const double exact = along - kFriction * down;
      const double found = sheet.velocity_along() / (num_steps * time_step);
      // A step that is solved to the tolerance may leave this much.
      EXPECT_NEAR(found, exact, 0.25 * SolverSettings{}.tolerance * kWeight)
          << "step " << time_step << " s, " << steeper << " times as steep";
    }
  }
}

// Friction is a thousandth of what rounding makes of a stiff spring's force, and brakes the sheet as a whole all the same.
template <class Scalar>
void expect_to_brake(double stiffness, double bound) {
  constexpr double kFriction = 0.4;
  constexpr double kTimeStep = 1.0 / 60;
  constexpr int kSteps = 25;
  SlidingSheet<Scalar> sheet(25, 0.5, 0.25, stiffness, kFriction);
  sheet.velocities().row(0).setConstant(2);
  for (int i = 1; i <= kSteps; ++i) {
    (void)sheet.step(kTimeStep, 0, kWeight);
    EXPECT_NEAR(sheet.velocity_along(), 2 - kFriction * kWeight * kTimeStep * i, bound)
        << stiffness << " N/m, step " << i;
  }
}

TEST(SlidingFriction, BrakesSheetsOfAnyStiffness) {
  for (const double stiffness : {1e2, 1e3, 1e4, 1e5, 1e6}) {
    expect_to_brake<double>(stiffness, 1e-3);
    // A hundredth of the motion of a step, in steps that rounding ends.
    expect_to_brake<float>(stiffness, 2e-2);
  }
}

// From rest: what rounding makes of stiff springs' forces is more than friction, and must not be taken for springs that hold the
// nodes back. Such sheets stood still for the first steps.
TEST(SlidingFriction, LetsStiffSheetsSlideFromTheFirstStepOn) {
  constexpr double kFriction = 0.2;
  constexpr double kTimeStep = 1.0 / 30;
  const double along = kWeight * std::sin(0.45), down = kWeight * std::cos(0.45);
  for (const double stiffness : {1e5, 2.5e5}) {
    SlidingSheet<float> sheet(15, 0.5, 0.0625, stiffness, kFriction);
    for (int i = 1; i <= 12; ++i) {
      EXPECT_TRUE(sheet.step(kTimeStep, along, down));
      const double exact = (along - kFriction * down) * kTimeStep * i;
      EXPECT_NEAR(sheet.velocity_along(), exact, 2e-2) << stiffness << " N/m, step " << i;
    }
  }
}

// Stiff springs and long steps: the inertia of the whole is less than the rounding of the coarse matrix. Such sheets lost a tenth of
// their friction in some steps and all of it in others, and turned, in steps that counted as solved.
TEST(SlidingFriction, BrakesSheetsWhoseInertiaRoundingHides) {
  constexpr double kFriction = 0.3;
  constexpr double kTimeStep = 1.0 / 30;
  for (const double stiffness : {1e6, 2.5e6}) {
    SlidingSheet<double> sheet(15, 0.5, 0.0625, stiffness, kFriction);
    sheet.velocities().row(0).setConstant(2);
    for (int i = 1; i <= 18; ++i) {
      EXPECT_TRUE(sheet.step(kTimeStep, 0, kWeight));
      EXPECT_NEAR(sheet.velocity_along(), 2 - kFriction * kWeight * kTimeStep * i, 1e-2)
          << stiffness << " N/m, step " << i;
      const Matrix3X<double>& v = sheet.velocities();
      EXPECT_LT((v.row(2).array() - v.row(2).mean()).abs().maxCoeff(), 1e-2);
    }
  }
}

}  // namespace
}  // namespace weft::fast
