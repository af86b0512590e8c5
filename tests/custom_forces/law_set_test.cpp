#include <weft/custom_forces/law_set.hpp>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <weft/core/error.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

using VelocityLaws = LawSet<double>::VelocityLaws;

const LawSpecification kTension{
    .law = "tension", .sets = {}, .parameters = {{"stiffness", {10.0}}}};
const LawSpecification kSpringDamping{
    .law = "spring_damping", .sets = {}, .parameters = {{"damping", {2.0}}}};
const LawSpecification kVelocityDamping{
    .law = "velocity_damping", .sets = {}, .parameters = {{"rate", {0.5}}}};
const LawSpecification kGravity{
    .law = "gravity", .sets = {}, .parameters = {{"acceleration", {0.0, -10.0, 0.0}}}};

class LawSetTest : public testing::Test {
 protected:
  LawSetTest() {
    positions_(0, 1) = 1.5;
    velocities_(0, 1) = 4.0;
    for (const auto& specification : {kTension, kSpringDamping, kVelocityDamping, kGravity}) {
      laws_.add(make_law<double>(specification, mesh_));
    }
  }
  [[nodiscard]] State<double> state() const { return {positions_, velocities_, mesh_.masses}; }

  ClothMesh mesh_ = one_spring(1.0);
  Matrix3X<double> positions_ = Matrix3X<double>::Zero(3, 2);
  Matrix3X<double> velocities_ = Matrix3X<double>::Zero(3, 2);
  Matrix3X<double> result_ = Matrix3X<double>::Zero(3, 2);
  LawSet<double> laws_;
};

TEST_F(LawSetTest, SumsItsLaws) {
  EXPECT_TRUE(laws_.add_forces(state(), VelocityLaws::kAsForces, result_).ok());
  // tension 10 * 0.5, spring damping 2 * 4, velocity damping 0.5 * 1 * 4
  EXPECT_NEAR(result_(0, 0), 5.0 + 8.0, 13.0 * kRoundoff);
  EXPECT_NEAR(result_(0, 1), -5.0 - 8.0 - 2.0, 15.0 * kRoundoff);
  EXPECT_NEAR(result_(1, 1), -10.0, 10.0 * kRoundoff);
}

TEST_F(LawSetTest, SeparateVelocityLawsAddNoForce) {
  EXPECT_TRUE(laws_.add_forces(state(), VelocityLaws::kSeparate, result_).ok());
  EXPECT_NEAR(result_(0, 1), -5.0 - 8.0, 13.0 * kRoundoff);
}

TEST_F(LawSetTest, VelocityLawsAloneAddTheirForceOnly) {
  EXPECT_TRUE(laws_.add_forces(state(), VelocityLaws::kAlone, result_).ok());
  EXPECT_NEAR(result_(0, 1), -2.0, 2.0 * kRoundoff);
  EXPECT_NEAR(result_(1, 1), 0.0, 0.0);
}

TEST_F(LawSetTest, InertiaLawsRedistributeAndStoreEnergy) {
  EXPECT_FALSE(laws_.has_level(LawTraits::Level::kInertia));
  result_(0, 1) = 6.0;
  laws_.redistribute_forces(state(), result_);
  EXPECT_EQ(result_(0, 1), 6.0);
  laws_.add(make_law<double>({"acceleration_damping", {}, {{"beta", {1.0}}}}, mesh_));
  EXPECT_TRUE(laws_.has_level(LawTraits::Level::kInertia));
  laws_.redistribute_forces(state(), result_);
  // 3 N move the centre of mass with each node, the other 3 N against it are halved
  EXPECT_NEAR(result_(0, 0), 1.5, 6.0 * kRoundoff);
  EXPECT_NEAR(result_(0, 1), 4.5, 6.0 * kRoundoff);
  // 1 / 2 * (2^2 + 2^2): speeds of 2 m/s relative to the centre of mass
  EXPECT_NEAR(laws_.added_kinetic_energy(state()), 4.0, 4.0 * kRoundoff);
}

TEST_F(LawSetTest, AdvancesVelocitiesByVelocityLawsOnly) {
  Matrix3X<double> velocities = velocities_;
  laws_.advance_velocities(state(), 2.0, velocities);
  EXPECT_NEAR(velocities(0, 1), 4.0 * std::exp(-1.0), 4.0 * kRoundoff);
}

TEST_F(LawSetTest, SumsEnergyAndPower) {
  EXPECT_NEAR(laws_.potential_energy(state()), 1.25, 1.25 * kRoundoff);
  EXPECT_NEAR(laws_.non_conservative_power(state()), -32.0 - 8.0, 40.0 * kRoundoff);
}

TEST_F(LawSetTest, SumsProductsWithVelocityLawsAmongThem) {
  Matrix3X<double> along = Matrix3X<double>::Zero(3, 2);
  along(0, 1) = 1.0;
  laws_.add_stiffness_product(state(), along, result_);
  EXPECT_NEAR(result_(0, 1), -10.0, 10.0 * kRoundoff);
  result_.setZero();
  laws_.add_damping_product(state(), along, result_);
  EXPECT_NEAR(result_(0, 1), -2.0 - 0.5, 2.5 * kRoundoff);
}

TEST_F(LawSetTest, AnEmptySetAddsNothing) {
  LawSet<double> none;
  EXPECT_TRUE(none.empty());
  EXPECT_TRUE(none.add_forces(state(), VelocityLaws::kAsForces, result_).ok());
  EXPECT_TRUE(result_.isZero(0));
  EXPECT_EQ(none.potential_energy(state()), 0.0);
}

TEST_F(LawSetTest, AStateThatIsNotFiniteIsReportedAndAddsNothing) {
  velocities_(2, 1) = std::numeric_limits<double>::quiet_NaN();
  const ForceReport report = laws_.add_forces(state(), VelocityLaws::kAsForces, result_);
  EXPECT_FALSE(report.ok());
  EXPECT_EQ(report.first_non_finite_node, 1);
  EXPECT_TRUE(result_.isZero(0));
}

TEST_F(LawSetTest, InfinitiesThatCancelAreNotFinite) {
  positions_(0, 0) = std::numeric_limits<double>::infinity();
  positions_(1, 0) = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(laws_.add_forces(state(), VelocityLaws::kAsForces, result_).first_non_finite_node, 0);
}

TEST_F(LawSetTest, WrongShapesAreRefusedWithTheirSizes) {
  Matrix3X<double> three = Matrix3X<double>::Zero(3, 3);
  EXPECT_THROW((void)laws_.add_forces(state(), VelocityLaws::kAsForces, three), InvalidArgument);
  EXPECT_THROW(laws_.advance_velocities(state(), 0.1, three), InvalidArgument);
  EXPECT_THROW(laws_.add_stiffness_product(state(), velocities_, three), InvalidArgument);
  EXPECT_THROW(laws_.add_stiffness_product(state(), three, result_), InvalidArgument);
  EXPECT_THROW(laws_.add_damping_product(state(), three, result_), InvalidArgument);
  velocities_ = three;
  EXPECT_THROW((void)laws_.potential_energy(state()), InvalidArgument);
  EXPECT_THROW((void)laws_.non_conservative_power(state()), InvalidArgument);
  try {
    (void)laws_.add_forces(state(), VelocityLaws::kAsForces, result_);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("positions 3 x 2, velocities 3 x 3"));
  }
}

TEST_F(LawSetTest, AStateOfAnotherMeshIsRefused) {
  const Matrix3X<double> three = Matrix3X<double>::Ones(3, 3);
  const VectorX<double> masses = VectorX<double>::Ones(3);
  Matrix3X<double> result = Matrix3X<double>::Zero(3, 3);
  const State<double> other{three, three, masses};
  EXPECT_THROW((void)laws_.add_forces(other, VelocityLaws::kAsForces, result), InvalidArgument);
}

TEST_F(LawSetTest, NoLawIsRefused) {
  EXPECT_THROW(laws_.add(nullptr), InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
