// Apart from the other contract tests, so that the thread sanitizer can run these alone.

#include <ostream>

#include "tests/contract/checks/order_checks.hpp"

namespace weft::contract {

void PrintTo(const Subject& subject, std::ostream* out) {
  *out << subject.name;
}

namespace {

class LawThreads : public testing::TestWithParam<Subject> {};

INSTANTIATE_TEST_SUITE_P(Registry, LawThreads, testing::ValuesIn(all_subjects()),
                         [](const auto& info) { return info.param.name; });

TEST_P(LawThreads, ChangeNoBit) {
  EXPECT_TRUE(holds(threads_change_no_bit<float>(GetParam())));
  EXPECT_TRUE(holds(threads_change_no_bit<double>(GetParam())));
}

}  // namespace
}  // namespace weft::contract
