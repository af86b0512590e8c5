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

// On parallel planes, with nothing held; on a ball it would be stretched.
TEST(CoarseRoles, SlideAsAWholeOnParallelPlanesOnly) {
  std::vector<ContactState> states(4, ContactState::kFree);
  states[1] = states[2] = ContactState::kOnPlane;
  Vector3<float> other(0, 1, 0);
  const auto on_planes = [&other](int node) {
    SlidingNode one = sliding(node);
    one.normal = node == 1 ? Vector3<float>(0, 1, 0) : other;
    return one;
  };
  CoarseRoles roles;
  roles.set({}, {}, states, on_planes);
  EXPECT_FALSE(roles.slide_as_a_whole());
  roles.set({1, 2}, {}, states, on_planes);
  EXPECT_TRUE(roles.slide_as_a_whole());
  other = Vector3<float>(0.01F, 1, 0).normalized();
  roles.set({1, 2}, {}, states, on_planes);
  EXPECT_FALSE(roles.slide_as_a_whole());
  other = {0, 1, 0};
  states[2] = ContactState::kFixed;
  roles.set({1, 2}, {}, states, on_planes);
  EXPECT_FALSE(roles.slide_as_a_whole());
}

}  // namespace
}  // namespace weft::fast
