#include <gtest/gtest.h>

#include <numeric>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/strain.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

TEST(Strain, OfAStretchedClothIsKnownPerDirection) {
  const ClothMesh mesh = flat_cloth(3, 2.0);
  const Edges stretch = mesh.edges_of({"stretch"});
  Matrix3X<double> positions = mesh.rest_positions;
  positions.row(0) *= 1.1;  // along u; v is along z
  positions.row(2) *= 0.8;
  const VectorX<double> strains =
      edge_strains(positions, stretch, edge_lengths(mesh.rest_positions, stretch));
  ASSERT_EQ(strains.size(), 12);
  for (Eigen::Index e = 0; e < strains.size(); ++e) {
    const bool along_u = stretch(1, e) - stretch(0, e) == 1;
    EXPECT_NEAR(strains[e], along_u ? 0.1 : -0.2, kRoundoff);
  }
  const StrainStatistics statistics = strain_statistics(strains);
  EXPECT_NEAR(statistics.minimum, -0.2, kRoundoff);
  EXPECT_NEAR(statistics.median, -0.05, kRoundoff);  // half of each
  EXPECT_NEAR(statistics.maximum, 0.1, kRoundoff);
  EXPECT_NEAR(statistics.mean_absolute, 0.15, kRoundoff);
  EXPECT_EQ(statistics.num_non_finite, 0);
}

TEST(Strain, PercentilesOfAHundredAndOneSteps) {
  const VectorX<double> strains = VectorX<double>::LinSpaced(101, 0.0, 1.0);
  const StrainStatistics statistics = strain_statistics(strains, {0.0, 2.0, 4});
  EXPECT_NEAR(statistics.percentile_5, 0.05, kRoundoff);
  EXPECT_NEAR(statistics.percentile_95, 0.95, kRoundoff);
  EXPECT_NEAR(statistics.percentile_99, 0.99, kRoundoff);
}

TEST(Strain, HistogramCountsEverySpringOnceInHalfOpenBins) {
  const VectorX<double> strains{{-0.6, -0.5, -0.25, 0.0, 0.25, 0.49999999, 0.5, 3.0}};
  const Histogram h = strain_statistics(strains, {-0.5, 0.5, 4}).histogram;
  EXPECT_EQ(h.counts, (std::vector<int>{1, 1, 1, 2}));
  EXPECT_EQ(h.num_below, 1);
  EXPECT_EQ(h.num_above, 2);
  // The largest number below the upper end may round to the bin beyond it.
  const VectorX<double> edge{{std::nextafter(0.3, 0.0)}};
  EXPECT_EQ(strain_statistics(edge, {-0.1, 0.3, 7}).histogram.counts.back(), 1);
}

TEST(Strain, ASingleNonFiniteStrainMakesEveryNumberNaN) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    const StrainStatistics s = strain_statistics(VectorX<double>{{0.1, bad, 0.2}});
    EXPECT_EQ(s.num_non_finite, 1);
    for (const double value : {s.minimum, s.percentile_5, s.median, s.percentile_95,
                               s.percentile_99, s.maximum, s.mean_absolute}) {
      EXPECT_TRUE(std::isnan(value));
    }
    EXPECT_EQ(std::accumulate(s.histogram.counts.begin(), s.histogram.counts.end(), 0), 2);
  }
}

TEST(Strain, RefusesInputThatMakesNoSense) {
  const Matrix3X<double> x = Matrix3X<double>::Zero(3, 2);
  const Edges edge = Edges{{0}, {1}};
  EXPECT_THROW((void)edge_strains(x, edge, VectorX<double>{{0.0}}), InvalidArgument);
  EXPECT_THROW((void)edge_strains(x, edge, VectorX<double>{{kNaN}}), InvalidArgument);
  EXPECT_THROW((void)edge_strains(x, edge, VectorX<double>{{1.0, 1.0}}), InvalidArgument);
  EXPECT_THROW((void)edge_strains(x.leftCols(1), edge, VectorX<double>{{1.0}}), InvalidArgument);
  EXPECT_THROW((void)strain_statistics(VectorX<double>(0)), InvalidArgument);
  EXPECT_THROW((void)strain_statistics(VectorX<double>{{0.0}}, {0.5, 0.5, 4}), InvalidArgument);
  EXPECT_THROW((void)strain_statistics(VectorX<double>{{0.0}}, {0.0, 0.5, 0}), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
