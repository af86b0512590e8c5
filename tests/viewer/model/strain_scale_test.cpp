#include <weft/viewer/model/strain_scale.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace weft::viewer {
namespace {

std::vector<Eigen::VectorXd> strains(double value) {
  return {Eigen::VectorXd::Constant(3, value)};
}

TEST(StrainScale, IsRoundGrowsAtOnceAndShrinksLater) {
  StrainScale scale;
  scale.include(strains(-0.013));
  EXPECT_NEAR(scale.limit(), 0.02, 1e-12);
  scale.include(strains(0.31));
  EXPECT_NEAR(scale.limit(), 0.5, 1e-12);
  for (int i = 1; i < StrainScale::kPatience; ++i) scale.include(strains(0.013));
  EXPECT_NEAR(scale.limit(), 0.5, 1e-12);
  scale.include(strains(0.013));
  EXPECT_NEAR(scale.limit(), 0.02, 1e-12);
  scale.reset();
  EXPECT_NEAR(scale.limit(), 0.01, 1e-12);
}

TEST(StrainScale, AFewNodesDoNotBleachTheOthers) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(1000, 0.013);
  values[17] = 5.0;
  StrainScale scale;
  scale.include({values});
  EXPECT_NEAR(scale.limit(), 0.02, 1e-12);
}

TEST(StrainScale, LeavesOutWhatIsNotFinite) {
  StrainScale scale;
  scale.include(strains(std::numeric_limits<double>::infinity()));
  scale.include(strains(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_NEAR(scale.limit(), 0.01, 1e-12);
}

TEST(StrainScale, TheFieldIsInPercent) {
  StrainScale scale;
  scale.include(strains(0.02));
  const scenes::ScalarField field = scale.field(strains(0.01));
  EXPECT_NEAR(field.maximum, 2.0, 1e-12);
  EXPECT_NEAR(field.minimum, -2.0, 1e-12);
  EXPECT_NEAR(field.values.at(0)[2], 1.0, 1e-12);
}

}  // namespace
}  // namespace weft::viewer
