// How dynamic bodies move with respect to the nodes that they meet: the rigid motion that fits best.
#include <weft/bridge/implicit/substeps/relative_motion.hpp>

#include <array>
#include <stdexcept>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <gtest/gtest.h>

namespace weft::bridge {
namespace {

/// A ball, a table that stands, and nodes: five at the ball, in the corners of a square and above one of them, and one on the table.
class MetNodes : public testing::Test {
 protected:
  static constexpr int kOnTable = 5;

  MetNodes() {
    ball_.setMassProps(1, btVector3(1, 1, 1));
    btTransform pose = btTransform::getIdentity();
    pose.setOrigin(kCenter);
    ball_.setWorldTransform(pose);
    const std::array<btVector3, 6> met = {btVector3(-1, 0, -1), btVector3(1, 0, -1),
                                          btVector3(1, 0, 1),   btVector3(-1, 0, 1),
                                          btVector3(-1, 1, -1), btVector3(0, 0, 0)};
    for (int k = 0; k < 6; ++k) {
      RigidContact& contact = contacts_[static_cast<std::size_t>(k)];
      contact.node = k;
      contact.collider = k == kOnTable ? 0 : 2;
      contact.object = k == kOnTable ? &table_ : static_cast<btCollisionObject*>(&ball_);
      contact.met = kCenter + met[static_cast<std::size_t>(k)];
    }
  }
  [[nodiscard]] btVector3 motion(int contact) const {
    return RelativeMotion(contacts_, velocities_).at(contacts_[static_cast<std::size_t>(contact)]);
  }
  /// Far from the origin.
  const btVector3 kCenter{100, -20, 3};
  btSphereShape shape_{1};
  btRigidBody ball_{1, nullptr, &shape_, btVector3(1, 1, 1)};
  btCollisionObject table_;
  std::array<RigidContact, 6> contacts_;
  Matrix3X<btScalar> velocities_ = Matrix3X<btScalar>::Zero(3, 6);
};

TEST_F(MetNodes, ThatStandAreMetAsFastAsTheBallMoves) {
  ball_.setLinearVelocity(btVector3(0, -2, 1));
  ball_.setAngularVelocity(btVector3(0.5, 3, -1));
  for (int k = 0; k < kOnTable; ++k) {
    const btVector3& met = contacts_[static_cast<std::size_t>(k)].met;
    const btVector3 expected = btVector3(0, -2, 1) + btVector3(0.5, 3, -1).cross(met - kCenter);
    EXPECT_LT(motion(k).distance(expected), 1e-5) << k;
  }
}

TEST_F(MetNodes, DoNotComeWhereTheyTurnWithTheBall) {
  ball_.setAngularVelocity(btVector3(0, 0, 4));
  for (int k = 0; k < kOnTable; ++k) {
    const btVector3 met = contacts_[static_cast<std::size_t>(k)].met - kCenter;
    const btVector3 turning = btVector3(0, 0, 4).cross(met);
    velocities_.col(k) << turning.x(), turning.y(), turning.z();
  }
  for (int k = 0; k < kOnTable; ++k) EXPECT_LT(motion(k).length(), 1e-4) << k;
}

TEST_F(MetNodes, DoNotComeWhereTheyShake) {
  for (int k = 0; k < 4; ++k) velocities_(1, k) = btScalar(k % 2 == 0 ? 5 : -5);
  velocities_(1, 4) = 5;
  contacts_[4].object = nullptr;
  for (int k = 0; k < 4; ++k) EXPECT_LT(motion(k).length(), 1e-5) << k;
}

TEST_F(MetNodes, OnOneLineDoNotTurnAboutIt) {
  ball_.setLinearVelocity(btVector3(0, -2, 0));
  for (RigidContact& contact : contacts_)
    contact.met = kCenter + btScalar(contact.node) * btVector3(1, 0, 0);
  velocities_(1, 0) = 3;
  EXPECT_NEAR(motion(0).y(), -2 - 3 * 0.6, 1e-5)
      << "of five points on a line the first has 0.6 of its own";
  EXPECT_NEAR(motion(0).z(), 0, 1e-5);
}

TEST_F(MetNodes, OfATableThatStandsAreNotLookedAt) {
  velocities_.col(kOnTable) << 0, -7, 0;
  EXPECT_EQ(motion(kOnTable), btVector3(0, 0, 0));
  RigidContact unknown = contacts_[0];
  unknown.collider = 3;
  EXPECT_THROW(static_cast<void>(RelativeMotion(contacts_, velocities_).at(unknown)),
               std::out_of_range);
}

}  // namespace
}  // namespace weft::bridge
