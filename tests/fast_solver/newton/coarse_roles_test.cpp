#include <gtest/gtest.h>

#include <weft/fast_solver/newton/coarse_roles.hpp>

namespace weft::fast {
namespace {

SlidingNode sliding(int node) {
  SlidingNode one;
  one.node = node;
  return one;
}

std::vector<BodyLink> links_of(const std::vector<int>& nodes) {
  std::vector<BodyLink> links;
  for (const int node : nodes) {
    links.push_back({node, 0, Vector3<float>::Zero(), Vector3<float>::Zero(), false});
  }
  return links;
}

std::vector<int> nodes_of(const std::vector<SlidingNode>& list) {
  std::vector<int> nodes;
  for (const SlidingNode& one : list) nodes.push_back(one.node);
  return nodes;
}

TEST(CoarseRoles, OnlyWhatSlidesOnFixedThingsTakesPart) {
  std::vector<ContactState> states(8, ContactState::kFree);
  states[1] = states[2] = states[5] = ContactState::kOnPlane;
  states[6] = ContactState::kFixed;
  CoarseRoles roles;
  roles.set({1, 2, 5, 6}, links_of({2}), states, sliding);
  EXPECT_EQ(nodes_of(roles.sliding()), (std::vector<int>{1, 5}));
  EXPECT_EQ(roles.held(), (std::vector<int>{2, 6}));
  EXPECT_EQ(roles.is_held(), (std::vector<char>{0, 0, 1, 0, 0, 0, 1, 0}));
}

// What was held in the iteration before, and is not now, takes part again.
TEST(CoarseRoles, ForgetTheIterationBefore) {
  std::vector<ContactState> states(4, ContactState::kOnPlane);
  CoarseRoles roles;
  roles.set({0, 1, 2, 3}, links_of({0, 3}), states, sliding);
  states[1] = ContactState::kFree;
  roles.set({0, 2, 3}, links_of({3}), states, sliding);
  EXPECT_EQ(nodes_of(roles.sliding()), (std::vector<int>{0, 2}));
  EXPECT_EQ(roles.held(), std::vector<int>{3});
  EXPECT_EQ(roles.is_held(), (std::vector<char>{0, 0, 0, 1}));
}

}  // namespace
}  // namespace weft::fast
