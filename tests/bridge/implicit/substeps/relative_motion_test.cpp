// How dynamic bodies move with respect to the nodes that they meet, as a whole.
#include <weft/bridge/implicit/substeps/relative_motion.hpp>

#include <array>
#include <stdexcept>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <gtest/gtest.h>

namespace weft::bridge {
namespace {

/// A ball, a table that stands, and three nodes: two at the ball, on both sides of it, and one on the table.
class MetNodes : public testing::Test {
 protected:
  MetNodes() {
    ball_.setMassProps(1, btVector3(1, 1, 1));
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      contacts_[k].node = static_cast<int>(k);
      contacts_[k].collider = k < 2 ? 2 : 0;
      contacts_[k].object = k < 2 ? static_cast<btCollisionObject*>(&ball_) : &table_;
      contacts_[k].met = btVector3(k == 0 ? -1 : 1, 0, 0);
    }
  }
  [[nodiscard]] btVector3 motion(int contact) const {
    return RelativeMotion(contacts_, velocities_).of(contacts_[static_cast<std::size_t>(contact)]);
  }
  btSphereShape shape_{1};
  btRigidBody ball_{1, nullptr, &shape_, btVector3(1, 1, 1)};
  btCollisionObject table_;
  std::array<RigidContact, 3> contacts_;
  Matrix3X<btScalar> velocities_ = Matrix3X<btScalar>::Zero(3, 3);
};

TEST_F(MetNodes, ComeWithTheMeanOfTheirVelocities) {
  ball_.setLinearVelocity(btVector3(0, -2, 0));
  velocities_.col(0) << 0, 5, 0;
  velocities_.col(1) << 0, -3, 0;
  EXPECT_EQ(motion(0), btVector3(0, -3, 0));
  EXPECT_EQ(motion(1), btVector3(0, -3, 0));
}

TEST_F(MetNodes, DoNotComeWhereTheyTurnWithTheBall) {
  ball_.setAngularVelocity(btVector3(0, 0, 4));
  velocities_.col(0) << 0, -4, 0;
  velocities_.col(1) << 0, 4, 0;
  EXPECT_EQ(motion(0), btVector3(0, 0, 0));
}

TEST_F(MetNodes, OfATableThatStandsAreNotLookedAt) {
  velocities_.col(2) << 0, -7, 0;
  EXPECT_EQ(motion(2), btVector3(0, 0, 0));
  RigidContact unknown = contacts_[0];
  unknown.collider = 3;
  EXPECT_THROW(static_cast<void>(RelativeMotion(contacts_, velocities_).of(unknown)),
               std::out_of_range);
}

}  // namespace
}  // namespace weft::bridge
