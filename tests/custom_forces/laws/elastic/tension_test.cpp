#include <weft/custom_forces/laws/elastic/tension.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <weft/core/error.hpp>
#include <weft/custom_forces/assembly/spring_set.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {
namespace {

constexpr double kTensionStiffness = 20.0;  // [N/m]
constexpr double kRestLength = 2.0;         // [m]
const Matrix3X<double> kStill = Matrix3X<double>::Zero(3, 2);

LawSpecification tension_of_ratio(double compression_ratio) {
  return {.law = "tension",
          .sets = {},
          .parameters = {{"stiffness", {kTensionStiffness}},
                         {"compression_ratio", {compression_ratio}}}};
}

Matrix3X<double> apart(double length) {
  Matrix3X<double> positions = kStill;
  positions(0, 1) = length;
  return positions;
}

double pull_at(double length, double compression_ratio) {
  return forces_on(tension_of_ratio(compression_ratio), one_spring(kRestLength), apart(length),
                   kStill)(0, 0);
}

double energy_at(double length, double compression_ratio) {
  const ClothMesh mesh = one_spring(kRestLength);
  const Matrix3X<double> positions = apart(length);
  return make_law<double>(tension_of_ratio(compression_ratio), mesh)
      ->potential_energy({positions, kStill, mesh.masses});
}

TEST(Tension, PullsByStiffnessTimesExtension) {
  EXPECT_NEAR(pull_at(2.5, 1.0), 10.0, 10.0 * kRoundoff);
  EXPECT_NEAR(energy_at(2.5, 1.0), 2.5, 2.5 * kRoundoff);
}

TEST(Tension, PullsAlongTheSpringInSpace) {
  Matrix3X<double> positions(3, 2);
  positions << 1, 3, 1, 4, 1, 7;  // difference (2, 3, 6), length 7
  const Matrix3X<double> force =
      forces_on(tension_of_ratio(1.0), one_spring(kRestLength), positions, kStill);
  const Vector3<double> expected = kTensionStiffness * 5.0 * Vector3<double>(2, 3, 6) / 7.0;
  EXPECT_LE((force.col(0) - expected).norm(), expected.norm() * kRoundoff);
  EXPECT_EQ(Vector3<double>(force.col(0)), Vector3<double>(-force.col(1)));
}

TEST(Tension, PushesByTheCompressionRatio) {
  EXPECT_NEAR(pull_at(1.5, 1.0), -10.0, 10.0 * kRoundoff);
  EXPECT_NEAR(pull_at(1.5, 0.25), -2.5, 2.5 * kRoundoff);
  EXPECT_EQ(pull_at(1.5, 0.0), 0.0);
  EXPECT_NEAR(energy_at(1.5, 0.25), 0.625, 0.625 * kRoundoff);
  EXPECT_EQ(energy_at(1.5, 0.0), 0.0);
}

TEST(Tension, TheRatioDoesNotTouchAStretchedSpring) {
  EXPECT_EQ(pull_at(2.5, 0.0), pull_at(2.5, 1.0));
}

TEST(Tension, TheRatioIsOneIfNotGiven) {
  const LawSpecification specification{
      .law = "tension", .sets = {}, .parameters = {{"stiffness", {kTensionStiffness}}}};
  EXPECT_EQ(forces_on(specification, one_spring(kRestLength), apart(1.5), kStill)(0, 0),
            pull_at(1.5, 1.0));
}

TEST(Tension, ASpringWithoutDirectionExertsNoForce) {
  for (const double length : {0.0, 0.5 * kMinLengthRatio * kRestLength}) {
    EXPECT_EQ(pull_at(length, 1.0), 0.0);
    const ClothMesh mesh = one_spring(kRestLength);
    const auto law = make_law<double>(tension_of_ratio(1.0), mesh);
    const Matrix3X<double> positions = apart(length);
    Matrix3X<double> scratch(3, law->scratch_columns());
    Matrix3X<double> product = kStill;
    law->add_stiffness_product({positions, kStill, mesh.masses}, apart(1.0), scratch, product);
    EXPECT_EQ(product, kStill);
  }
  EXPECT_NE(pull_at(2 * kMinLengthRatio * kRestLength, 1.0), 0.0);
}

TEST(Tension, AWeightHangsByMassTimesGravityOverStiffness) {
  const double weight = 9.81;  // [N]
  EXPECT_NEAR(pull_at(kRestLength + weight / kTensionStiffness, 1.0), weight,
              kTensionStiffness * kRoundoff);
}

TEST(Tension, ActsOnTheNamedSetsOnly) {
  ClothMesh mesh = one_spring(kRestLength);
  mesh.edge_sets.push_back({"none", Edges(2, 0)});
  LawSpecification specification = tension_of_ratio(1.0);
  specification.sets = {"none"};
  EXPECT_EQ(forces_on(specification, mesh, apart(3.0), kStill), kStill);
}

TEST(Tension, AnEdgeWithoutRestLengthIsRefused) {
  try {
    (void)make_law<double>(tension_of_ratio(1.0), one_spring(0.0));
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("tension: rest length of the edge between nodes 0"));
    EXPECT_THAT(error.what(), testing::HasSubstr("[m], expected > 0"));
  }
}

TEST(Tension, AnEdgeToANodeThatIsNotThereIsRefused) {
  ClothMesh mesh = one_spring(kRestLength);
  mesh.edge_sets.front().edges(1, 0) = 2;
  EXPECT_THROW((void)make_law<double>(tension_of_ratio(1.0), mesh), InvalidArgument);
  mesh.edge_sets.front().edges << -1, 1;
  EXPECT_THROW((void)make_law<double>(tension_of_ratio(1.0), mesh), InvalidArgument);
}

}  // namespace
}  // namespace weft::forces
