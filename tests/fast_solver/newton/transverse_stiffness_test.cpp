#include <weft/fast_solver/newton/transverse_stiffness.hpp>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

TEST(TransverseStiffness, IsRaisedUntilNoIterationCanGainEnergy) {
  TransverseStiffness transverse;
  EXPECT_FALSE(transverse.is_raised());
  double last = 0;
  while (transverse.raise()) {
    EXPECT_GT(transverse.share(), last);
    EXPECT_LE(transverse.share(), 1.0);
    last = transverse.share();
  }
  EXPECT_EQ(last, 1.0);
  EXPECT_FALSE(transverse.is_raised()) << "the next iteration begins anew";
}

TEST(TransverseStiffness, IsLoweredToNothing) {
  TransverseStiffness transverse;
  ASSERT_TRUE(transverse.raise());
  ASSERT_TRUE(transverse.raise());
  const double second = transverse.share();
  transverse.lower();
  EXPECT_GT(transverse.share(), 0);
  EXPECT_LT(transverse.share(), second);
  transverse.lower();
  EXPECT_EQ(transverse.share(), 0);
  transverse.lower();
  EXPECT_EQ(transverse.share(), 0);
}

}  // namespace
}  // namespace weft::fast
