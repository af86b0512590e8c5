#include <weft/validation/contact_table/passage.hpp>

#include <gtest/gtest.h>

namespace weft::validation {
namespace {

const Pose kHere;

Matrix3X<double> at(double x, double y) {
  return Vector3<double>(x, y, 0);
}

TEST(Passage, ANodeThatRestsShallowIsDeepButNotThrough) {
  Passage passage(scenes::SphereShape{1.0}, 1.0);
  passage.add(kHere, at(0, 1.2));
  passage.add(kHere, at(0, 0.9));
  passage.add(kHere, at(0, 0.95));
  EXPECT_DOUBLE_EQ(passage.deepest(), 1.0 - 0.9);
  EXPECT_DOUBLE_EQ(passage.deepest_now(), 1.0 - 0.95);
  EXPECT_EQ(passage.num_tunnelled(), 0);
}

TEST(Passage, ANodeThatEndsDeepInsideHasTunnelled) {
  Passage passage(scenes::SphereShape{1.0}, 1.0);
  passage.add(kHere, at(0, 1.2));
  passage.add(kHere, at(0, 0.3));
  EXPECT_EQ(passage.num_tunnelled(), 1);
  passage.add(kHere, at(0, 1.1));  // pushed back the way it came
  EXPECT_EQ(passage.num_tunnelled(), 0);
}

TEST(Passage, ANodeThatPassesInOneStepHasTunnelled) {
  Passage passage(scenes::SphereShape{1.0}, 1.0);
  passage.add(kHere, at(0, 1.5));
  passage.add(kHere, at(0, -1.5));
  EXPECT_EQ(passage.num_tunnelled(), 1);
  EXPECT_EQ(passage.deepest(), 0.0);  // at no end of a step it was inside
}

TEST(Passage, ANodeThatOnlyGrazesHasNot) {
  Passage passage(scenes::SphereShape{1.0}, 1.0);
  passage.add(kHere, at(0.98, 1.5));
  passage.add(kHere, at(0.98, -1.5));
  EXPECT_EQ(passage.num_tunnelled(), 0);
}

TEST(Passage, AMovingSolidThatPassesANodeCountsAlike) {
  Passage passage(scenes::SphereShape{1.0}, 1.0);
  passage.add({{0, 1.5, 0}, Eigen::Quaterniond::Identity()}, at(0, 0));
  passage.add({{0, -1.5, 0}, Eigen::Quaterniond::Identity()}, at(0, 0));
  EXPECT_EQ(passage.num_tunnelled(), 1);
}

}  // namespace
}  // namespace weft::validation
