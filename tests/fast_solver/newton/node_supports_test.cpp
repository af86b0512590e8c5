// Cloth that a rigid plate presses on something: balances of forces in one step.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <weft/fast_solver/implicit_solver.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::fast {
namespace {

constexpr double kPressedStep = 1.0 / 60;  // [s]
constexpr double kFall = 9.81 * kPressedStep * kPressedStep;
constexpr double kPlate = 2;  // [kg]

RigidInertia<double> plate(double mass, double fall) {
  RigidInertia<double> inertia;
  inertia.mass.setConstant(mass);
  inertia.inertia = 0.1 * mass * Matrix3<double>::Identity();
  inertia.motion = {0, -fall, 0};
  return inertia;
}

/// A cloth of 0.25 kg with a plate on it, both of which fall or slide in a step; under it something at height 0.
class Pressed {
 public:
  explicit Pressed(double velocity) {
    ClothGrid grid;
    grid.nodes = {5, 5};
    grid.total_mass = 0.25;
    mesh_ = make_cloth_grid(grid);
    starts_ = mesh_.rest_positions;
    inertial_ = starts_;
    inertial_.row(0).array() += velocity * kPressedStep;
    inertial_.row(1).array() -= kFall;
    bodies_ = {plate(kPlate, kFall)};
    for (int i = 0; i < mesh_.num_nodes(); ++i) {
      PlaneContact<double> contact;
      contact.node = i;
      contact.normal = {0, -1, 0};
      contact.offset = kFall;  // the plate has fallen
      contact.motion = {0, -kFall, 0};
      contact.body = 0;
      contact.lever_arm = starts_.col(i);
      contacts_.push_back(contact);
      NodeSupport<double> support;
      support.node = i;
      support.normal = {0, 1, 0};
      support.stiffness = 10 * kPlate / (kPressedStep * kPressedStep) / mesh_.num_nodes();
      supports_.push_back(support);
    }
  }
  std::vector<NodeSupport<double>>& supports() { return supports_; }
  std::vector<RigidInertia<double>>& bodies() { return bodies_; }

  void solve() {
    const SpringNetwork network = make_network(mesh_, {{"tension", {}, {{"stiffness", {1000.0}}}}});
    const std::vector<bool> is_free(static_cast<std::size_t>(mesh_.num_nodes()), true);
    solver_ = std::make_unique<ImplicitSolver<double>>(network, mesh_.masses, is_free);
    positions_ = inertial_;
    solver_->solve({inertial_,
                    starts_,
                    kPressedStep,
                    kPressedStep,
                    contacts_,
                    {},
                    bodies_,
                    nullptr,
                    false,
                    {},
                    supports_},
                   {}, positions_);
  }
  const ImplicitSolver<double>& solver() { return *solver_; }
  /// [N] That the step has given to the cloth.
  Vector3<double> force_on_cloth() {
    return (positions_ - inertial_) * mesh_.masses / (kPressedStep * kPressedStep);
  }
  /// [N] Likewise to a plate.
  Vector3<double> force_on(int body) {
    return bodies_[static_cast<std::size_t>(body)].mass.cwiseProduct(
               solver_->body_motion(body).head<3>()) /
           (kPressedStep * kPressedStep);
  }
  /// [N] That what is under it has given to both.
  Vector3<double> force_from_below() {
    Vector3<double> sum = Vector3<double>::Zero();
    for (std::size_t k = 0; k < supports_.size(); ++k) sum += solver_->support_force(k);
    return sum;
  }
  double height_of_nodes() { return positions_.row(1).mean(); }

 private:
  ClothMesh mesh_;
  Matrix3X<double> starts_;
  Matrix3X<double> inertial_;
  Matrix3X<double> positions_;
  std::vector<PlaneContact<double>> contacts_;
  std::vector<NodeSupport<double>> supports_;
  std::vector<RigidInertia<double>> bodies_;
  std::unique_ptr<ImplicitSolver<double>> solver_;
};

TEST(NodeSupports, BearThePlateAndTheCloth) {
  Pressed pressed(0);
  pressed.solve();
  EXPECT_TRUE(pressed.solver().report().is_converged);
  const double from_below = pressed.force_from_below().y();
  EXPECT_NEAR(pressed.force_on(0).y() + pressed.force_on_cloth().y(), from_below,
              1e-3 * from_below);
  // Ten times as stiff as the plate's inertia, they let both fall by a tenth of their way.
  const double depth = kFall * (kPlate + 0.25) / (11 * kPlate + 0.25);
  EXPECT_NEAR(pressed.height_of_nodes(), -depth, 1e-3 * depth);
  EXPECT_NEAR(pressed.solver().body_motion(0)[1] - kFall, pressed.height_of_nodes(), 1e-9);
}

TEST(NodeSupports, HoldClothBackByCoulombsLaw) {
  Pressed pressed(1);
  for (NodeSupport<double>& support : pressed.supports()) support.friction = 0.3;
  pressed.solve();
  const Vector3<double> from_below = pressed.force_from_below();
  EXPECT_NEAR(from_below.x(), -0.3 * from_below.y(), 1e-3 * from_below.y());
  EXPECT_NEAR(pressed.force_on_cloth().x(), from_below.x(), 1e-3 * from_below.y());
}

TEST(NodeSupports, GiveABodyBehindWhatTheyBear) {
  Pressed pressed(0);
  pressed.bodies().push_back(plate(3 * kPlate, 0));
  for (NodeSupport<double>& support : pressed.supports()) support.body = 1;
  pressed.solve();
  EXPECT_LT(pressed.force_on(1).y(), -0.3 * kPlate * 9.81);
  EXPECT_NEAR(pressed.force_on(0).y() + pressed.force_on(1).y() + pressed.force_on_cloth().y(), 0,
              1e-3 * kPlate * 9.81);
}

TEST(NodeSupports, OnlyPush) {
  Pressed pressed(0);
  for (NodeSupport<double>& support : pressed.supports()) support.offset = -1;  // far below
  pressed.solve();
  EXPECT_EQ(pressed.force_from_below().norm(), 0);
}

}  // namespace
}  // namespace weft::fast
