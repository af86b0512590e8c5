#include <weft/fast_solver/coarse/coarse_row.hpp>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

constexpr float kLeast = 0.1F;

CoarseRow row_of(std::initializer_list<CoarseRow::Entry> entries) {
  CoarseRow row;
  for (const auto& [basis, coefficient] : entries) row.add(basis, coefficient);
  return row;
}
float coefficient_of(const CoarseRow& row, int basis) {
  for (const CoarseRow::Entry& one : row) {
    if (one.basis == basis) return one.coefficient;
  }
  return 0;
}

TEST(CoarseRow, AddsUpCoefficientsOfTheSameFunction) {
  const CoarseRow row = row_of({{3, 0.5F}, {7, -1}, {3, 0.25F}});
  EXPECT_EQ(row.count, 2);
  EXPECT_EQ(coefficient_of(row, 3), 0.75F);
}

TEST(CoarseRow, GivesSmallCoefficientsToTheLargestOfTheirSign) {
  const CoarseRow row = row_of({{1, -0.03F}, {2, 0.4F}, {3, 0.02F}, {4, -0.9F}, {5, 0.5F}});
  const CoarseRow merged = row.merged(kLeast, [](int, int) { return true; });
  EXPECT_EQ(merged.count, 3);
  EXPECT_FLOAT_EQ(coefficient_of(merged, 4), -0.93F);
  EXPECT_FLOAT_EQ(coefficient_of(merged, 5), 0.52F);
  EXPECT_FLOAT_EQ(coefficient_of(merged, 2), 0.4F);
}

// Every two functions that stay are coupled, so that the whole square can be stored.
TEST(CoarseRow, MergesFunctionsThatAreNotCoupled) {
  const CoarseRow row = row_of({{1, 1}, {2, -0.6F}, {3, -0.4F}});
  const CoarseRow merged =
      row.merged(kLeast, [](int one, int other) { return one + other != 5; });  // 2 and 3
  EXPECT_EQ(merged.count, 2);
  EXPECT_FLOAT_EQ(coefficient_of(merged, 1), 1);
  EXPECT_FLOAT_EQ(coefficient_of(merged, 2), -1);
}

TEST(CoarseRow, HasAllOfItAtOneFunctionIfNoOtherHasItsSign) {
  const CoarseRow row = row_of({{1, 1}, {2, -0.05F}});
  const CoarseRow merged = row.merged(kLeast, [](int, int) { return true; });
  EXPECT_EQ(merged.count, 1);
  EXPECT_FLOAT_EQ(coefficient_of(merged, 1), 0.95F);
  EXPECT_EQ(CoarseRow{}.merged(kLeast, [](int, int) { return true; }).count, 0);
}

}  // namespace
}  // namespace weft::fast
