// Tested: the friction of one node, against Coulomb's law.
#include <weft/fast_solver/newton/sliding_friction.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

constexpr int kNode = 3;
constexpr double kBound = 0.4;                                                              // [N]
constexpr double kResistance = 20;                                                          // [N/m]
constexpr double kLeastSlip = kBound / (SlidingFriction<double>::kStiffest * kResistance);  // [m]

SlidingFriction<double> friction_with(double bound, double rounding = 0) {
  SlidingFriction<double> friction;
  friction.resize(16);
  friction.begin_step();
  friction.set_bound(kNode, bound, kResistance, rounding);
  return friction;
}

TEST(CoulombDrag, OpposesTheSlipWithItsBound) {
  SlidingFriction<double> friction = friction_with(kBound);
  const Vector3<double> slip(3e-3, 0, -4e-3);
  friction.set_slip(kNode, slip, true);
  EXPECT_NEAR((friction.force(kNode).cast<double>() + kBound * slip.normalized()).norm(), 0, 1e-7);
  friction.release(kNode);
  EXPECT_EQ(friction.force(kNode).norm(), 0);
  EXPECT_EQ(friction.drags()[kNode], 0);
  EXPECT_EQ(friction.energy(kNode, 1.0), 0);
}

TEST(CoulombDrag, IsTheGradientOfItsEnergyAtAnySlip) {
  SlidingFriction<double> friction = friction_with(kBound);
  for (const double slip : {0.1, 0.5, 0.999, 1.001, 2.0, 100.0}) {
    const double size = slip * kLeastSlip;
    const double change = 1e-4 * size;
    friction.set_slip(kNode, {0, size, 0}, true);
    const double slope =
        (friction.energy(kNode, size + change) - friction.energy(kNode, size - change)) /
        (2 * change);
    EXPECT_NEAR(-static_cast<double>(friction.force(kNode).y()), slope, 1e-3 * kBound) << slip;
    EXPECT_NEAR(-friction.force_at(kNode, {0, size, 0}).y(), slope, 1e-3 * kBound) << slip;
  }
}

// The linear system may have another one, for the slip that is expected.
TEST(CoulombDrag, HasItsForceAtAnySlipWhateverSlipIsExpected) {
  SlidingFriction<double> friction = friction_with(kBound);
  const Vector3<double> slip(2 * kLeastSlip, 0, 0);
  friction.expect_slip(kNode, slip, 8 * kLeastSlip);
  EXPECT_NEAR(friction.force(kNode).x(), -kBound / 4, 1e-6);
  EXPECT_NEAR(friction.force_at(kNode, slip).x(), -kBound, 1e-12);
  friction.release(kNode);
  EXPECT_EQ(friction.force_at(kNode, slip).norm(), 0);
}

TEST(CoulombDrag, HoldsWhatSlipsLessThanTheLeastSlip) {
  SlidingFriction<double> friction = friction_with(kBound);
  for (const double slip : {0.0, 0.1, 0.99, 1.01, 50.0}) {
    friction.set_slip(kNode, {slip * kLeastSlip, 0, 0}, true);
    EXPECT_EQ(friction.holds(kNode), slip < 1) << slip;
  }
  friction.release(kNode);
  EXPECT_FALSE(friction.holds(kNode));
}

TEST(CoulombDrag, IsNoStifferThanRoundingAllows) {
  const double rounding = 10 * kLeastSlip;
  SlidingFriction<double> friction = friction_with(kBound, rounding);
  friction.set_slip(kNode, {rounding, 0, 0}, true);
  EXPECT_LE(friction.force(kNode).norm(), 0.26 * kBound);
}

// A body may begin to press a node after the node's bound was set, and before the node has moved.
TEST(CoulombDrag, OfANodeThatIsPressedLaterAndHasNotMovedIsFinite) {
  SlidingFriction<double> friction = friction_with(0);
  friction.add_to_bound(kNode, kBound);
  friction.set_slip(kNode, Vector3<double>::Zero(), false);
  EXPECT_EQ(friction.force(kNode).norm(), 0);
  EXPECT_TRUE(std::isfinite(friction.drags()[kNode]));
  friction.set_slip(kNode, {1e-3, 0, 0}, false);
  EXPECT_NEAR(-static_cast<double>(friction.force(kNode).x()), kBound, 1e-6);
}

/// The stiffness of friction against displacements of the node.
Matrix3<float> stiffness_of(const SlidingFriction<double>& friction) {
  NodeArrays<float> displacements = NodeArrays<float>::Zero(16, 3);
  Matrix3<float> stiffness;
  for (int axis = 0; axis < 3; ++axis) {
    displacements.row(kNode).setZero();
    displacements(kNode, axis) = 1;
    NodeArrays<float> product = static_cast<float>(friction.drags()[kNode]) * displacements;
    friction.relieve_product(kNode, displacements, product);
    stiffness.col(axis) = product.row(kNode).transpose();
  }
  return stiffness;
}

TEST(CoulombDrag, RelievedIsTheSecondDerivativeOfALongSlip) {
  SlidingFriction<double> friction = friction_with(kBound);
  const Vector3<double> slip = 1000 * kLeastSlip * Vector3<double>(2, 0, 1).normalized();
  friction.set_slip(kNode, slip, true);
  const Vector3<float> along = slip.normalized().cast<float>();
  const auto drag = static_cast<float>(kBound / slip.norm());
  const Matrix3<float> expected = drag * (Matrix3<float>::Identity() - along * along.transpose());
  EXPECT_LT((stiffness_of(friction) - expected).norm(), 2e-3F * drag);
  friction.set_slip(kNode, slip, false);
  EXPECT_LT((stiffness_of(friction) - drag * Matrix3<float>::Identity()).norm(), 1e-5F * drag);
}

TEST(CoulombDrag, RelievesANodeThatTurnsAroundHalfAsMuchEachTime) {
  SlidingFriction<double> friction = friction_with(kBound);
  double last = 0;
  for (int turn = 0; turn < 4; ++turn) {
    const double slip = (turn % 2 == 0 ? 1 : -1) * 100 * kLeastSlip;
    friction.set_slip(kNode, {slip, 0, 0}, true);
    const double relief =
        friction.drags()[kNode] - static_cast<double>(stiffness_of(friction)(0, 0));
    EXPECT_GT(relief, 0);
    if (turn > 0) {
      EXPECT_NEAR(relief, last / 2, 1e-3 * last);
    }
    last = relief;
  }
  friction.begin_step();
  friction.set_slip(kNode, {100 * kLeastSlip, 0, 0}, true);
  EXPECT_NEAR(static_cast<double>(stiffness_of(friction)(0, 0)), 0, 0.02 * friction.drags()[kNode]);
}

TEST(CoulombDrag, InvertsItsBlockWithTheRelief) {
  constexpr float kFactor = 0.6F;
  SlidingFriction<double> friction = friction_with(kBound);
  friction.set_slip(kNode, {4e-3, -1e-3, 2e-3}, true);
  Matrix3<float> block;
  block << 30, 4, -2, 4, 25, 3, -2, 3, 40;
  const auto drag = static_cast<float>(friction.drags()[kNode]);
  const Matrix3<float> before = kFactor * (block + drag * Matrix3<float>::Identity()).inverse();
  BlockArrays inverse = BlockArrays::Zero(16, 6);
  inverse.row(kNode) << before(0, 0), before(1, 1), before(2, 2), before(0, 1), before(1, 2),
      before(2, 0);
  friction.relieve_inverse(kNode, kFactor, inverse);
  const Matrix3<float> after = kFactor * (block + stiffness_of(friction)).inverse();
  Eigen::Matrix<float, 1, 6> expected;
  expected << after(0, 0), after(1, 1), after(2, 2), after(0, 1), after(1, 2), after(2, 0);
  EXPECT_LT((inverse.row(kNode) - expected).norm(), 1e-4F * expected.norm());
}

}  // namespace
}  // namespace weft::fast
