// The transverse stiffness of the linearization, while iterations are taken back and while they are not.
#include <weft/fast_solver/newton/transverse_share.hpp>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

TEST(TransverseShare, GrowsToOneWhileIterationsAreTakenBack) {
  TransverseShare share;
  EXPECT_EQ(share.value(), 0);
  double last = 0;
  int count = 0;
  for (; !share.is_largest() && count < 10; ++count) {
    share.grow();
    EXPECT_GT(share.value(), last);
    last = share.value();
  }
  EXPECT_EQ(share.value(), 1);
  EXPECT_EQ(count, 4) << "0.02, 0.14, 0.98 and 1";
  share.grow();
  EXPECT_EQ(share.value(), 1);
}

TEST(TransverseShare, ShrinksToNoneAfterIterationsThatSucceed) {
  TransverseShare share;
  share.shrink();
  EXPECT_EQ(share.value(), 0);
  share.grow();
  share.grow();
  share.shrink();
  EXPECT_DOUBLE_EQ(share.value(), 0.02);
  share.shrink();
  EXPECT_EQ(share.value(), 0);
  share.grow();
  share.forget();
  EXPECT_EQ(share.value(), 0);
}

}  // namespace
}  // namespace weft::fast
