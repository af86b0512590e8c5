#include <gtest/gtest.h>

#include "bench/bullet/workloads/rest_drape.hpp"

namespace weft::bench {
namespace {

constexpr double kBound = 0.01;  // [m] a hundredth of the cloth

TEST(RestDrape, DependsNeitherOnTheTimeStepNorOnTheEffort) {
  for (const RestDrape drape : {RestDrape::kHammock, RestDrape::kBanner}) {
    const Matrix3X<double> exact = rest_of(drape, {4, 20, 1.0 / 60});
    for (const double rate : {30.0, 60.0, 120.0, 240.0}) {
      for (const auto& [rounds, iterations] : {std::pair{1, 1}, std::pair{2, 3}}) {
        const Matrix3X<double> rest = rest_of(drape, {rounds, iterations, 1 / rate});
        EXPECT_LT(distances(drape, rest, exact).maxCoeff(), kBound)
            << to_string(drape) << " 1/" << rate << " s, " << rounds << " x " << iterations;
      }
    }
  }
}

TEST(RestDrape, OfBulletsLinksDependsOnTheTimeStep) {
  const Matrix3X<double> exact = rest_of(RestDrape::kHammock, {4, 20, 1.0 / 60});
  const Matrix3X<double> rest = rest_of(RestDrape::kHammock, {0, 50, 1.0 / 30});
  EXPECT_GT(distances(RestDrape::kHammock, rest, exact).maxCoeff(), 2 * kBound);
}

}  // namespace
}  // namespace weft::bench
