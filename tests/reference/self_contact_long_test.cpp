// The runs of self_contact_test.cpp, finer and longer.
#include <gtest/gtest.h>

#include "tests/reference/layer_runs.hpp"

namespace weft::reference::testing {
namespace {

TEST(SelfContactLong, AFoldingDropComesToRestWithoutACrossing) {
  int stopped = 0;
  EXPECT_EQ(crossings_of_fold(folding_strip(9, true), 1.5, &stopped), 0);
  EXPECT_EQ(stopped, 0);
}

TEST(SelfContactLong, AClothTwistedByTwoTurnsHasNoCrossing) {
  int stopped = 0;
  EXPECT_EQ(crossings_of_twist(13, 2.0, true, &stopped), 0);
  EXPECT_EQ(stopped, 0);
}

}  // namespace
}  // namespace weft::reference::testing
