// The velocity of the nodes that an object meets, as a whole.
#include <weft/bridge/implicit/substeps/mean_velocities.hpp>

#include <array>
#include <stdexcept>

#include <gtest/gtest.h>

namespace weft::bridge {
namespace {

RigidContact contact_of(int node, int collider) {
  RigidContact contact;
  contact.node = node;
  contact.collider = collider;
  return contact;
}

TEST(MeanVelocities, AreOfTheNodesThatTheObjectMeets) {
  Matrix3X<btScalar> velocities(3, 3);
  velocities << 3, -1, 8,  //
      1, 1, 1,             //
      -2, 2, 5;
  const std::array contacts{contact_of(0, 2), contact_of(1, 2), contact_of(2, 0)};
  const MeanVelocities means(contacts, velocities);
  EXPECT_EQ(means.at(contacts[0]), btVector3(1, 1, 0));
  EXPECT_EQ(means.at(contacts[2]), btVector3(8, 1, 5));
  EXPECT_THROW(static_cast<void>(means.at(contact_of(0, 3))), std::out_of_range);
}

}  // namespace
}  // namespace weft::bridge
