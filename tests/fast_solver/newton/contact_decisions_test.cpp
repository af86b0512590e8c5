#include <gtest/gtest.h>

#include <weft/fast_solver/newton/contact_decisions.hpp>

namespace weft::fast {
namespace {

/// Iterations that gain a tenth of the one before and are over at 1e-6 J; states change in the first `num_changes` decisions.
/// Returns how many iterations decided.
int run(ContactDecisions& decisions, int num_iterations, int num_changes) {
  int num_decisions = 0;
  double gain = 1;
  for (int k = 0; k < num_iterations; ++k) {
    const bool have_changed = decisions.decides() && num_decisions < num_changes;
    if (decisions.decides()) ++num_decisions;
    if (have_changed) gain = 1;
    decisions.add(k == 0, have_changed);
    const bool is_over = gain < 1e-6;
    if (is_over && decisions.are_confirmed(have_changed)) break;
    decisions.plan(k, gain, is_over, false);
    gain *= 0.1;
  }
  return num_decisions;
}

TEST(ContactDecisions, AreInTheFirstIterations) {
  ContactDecisions decisions(true, false, false);
  EXPECT_TRUE(decisions.decides());
  EXPECT_EQ(run(decisions, 4, 4), 3);
  ContactDecisions pressed(true, true, false);
  EXPECT_EQ(run(pressed, 4, 4), 4);
  ContactDecisions part(true, false, true);
  EXPECT_EQ(run(part, 2, 4), 1);
}

// Before the states are right nobody needs their solution to the last digit.
TEST(ContactDecisions, FollowWhereGainsHaveShrunkToAHundredth) {
  ContactDecisions decisions(true, false, true);
  decisions.add(true, true);
  decisions.plan(0, 1.0, false, false);
  decisions.add(false, false);
  decisions.plan(1, 0.02, false, false);
  EXPECT_FALSE(decisions.decides());
  decisions.add(false, false);
  decisions.plan(2, 0.009, false, false);
  EXPECT_TRUE(decisions.decides());
}

// Planes that have just been met bear less than springs that they have compressed would say.
TEST(ContactDecisions, WaitWhereNodesHaveJustMetPlanes) {
  ContactDecisions decisions(true, false, false);
  decisions.add(true, true);
  decisions.plan(0, 1.0, false, true);
  EXPECT_FALSE(decisions.decides());
  EXPECT_FALSE(decisions.are_settled());
  decisions.add(false, false);
  decisions.plan(1, 100.0, false, false);
  EXPECT_TRUE(decisions.decides());
}

TEST(ContactDecisions, AreConfirmedByOneThatChangesNothing) {
  ContactDecisions decisions(true, false, false);
  EXPECT_FALSE(decisions.are_settled());
  EXPECT_LT(run(decisions, 100, 2), ContactDecisions::kMost);
  EXPECT_TRUE(decisions.are_settled());
}

TEST(ContactDecisions, EndWithTheLastOne) {
  ContactDecisions decisions(true, false, false);
  EXPECT_EQ(run(decisions, 100, 100), ContactDecisions::kMost);
  EXPECT_FALSE(decisions.can_decide());
  EXPECT_TRUE(decisions.are_settled());
}

TEST(ContactDecisions, WithoutContactsAreNone) {
  ContactDecisions decisions(false, false, false);
  EXPECT_TRUE(decisions.are_settled());
  EXPECT_TRUE(decisions.are_confirmed(false));
  EXPECT_FALSE(decisions.can_decide());
}

}  // namespace
}  // namespace weft::fast
