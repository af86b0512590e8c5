#include <weft/bridge/rigid/rigid_substeps.hpp>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <gtest/gtest.h>

namespace weft::bridge {
namespace {

constexpr btScalar kWholeStep = btScalar(0.02);  // [s]
constexpr int kSubsteps = 4;

/// A ball that falls, moved by Bullet already: from height 0, to the velocity that it has now.
class FallingBall : public testing::Test {
 protected:
  FallingBall()
      : shape_(btScalar(0.1)),
        ball_(btRigidBody::btRigidBodyConstructionInfo(2, nullptr, &shape_, {1, 1, 1})) {
    ball_.setGravity({0, -10, 0});
    ball_.setLinearVelocity({1, kWholeStep * -10, 0});
    btTransform pose = btTransform::getIdentity();
    pose.setOrigin(kWholeStep * ball_.getLinearVelocity());
    ball_.setCenterOfMassTransform(pose);
  }
  btScalar fall_speed() const { return -ball_.getLinearVelocity().y(); }

  btSphereShape shape_;
  btRigidBody ball_;
};

TEST_F(FallingBall, HasAllOfGravityInTheFirstSubstep) {
  RigidSubsteps rigid({MovableObject(&ball_)}, kWholeStep, kSubsteps);
  for (int k = 0; k < kSubsteps; ++k) {
    rigid.begin_substep();
    EXPECT_FLOAT_EQ(static_cast<float>(fall_speed()), 0.2F) << k;
    rigid.end_substep();
  }
  rigid.finish();
  EXPECT_NEAR(ball_.getCenterOfMassPosition().y(), -0.004, 1e-7);
}

TEST_F(FallingBall, HasAShareOfGravityInEachSubstep) {
  RigidSubsteps rigid({MovableObject(&ball_)}, kWholeStep, kSubsteps);
  rigid.share_out_gravity(0, nullptr);
  for (int k = 0; k < kSubsteps; ++k) {
    rigid.begin_substep();
    EXPECT_NEAR(fall_speed(), 0.05 * (k + 1), 1e-7) << k;
    rigid.end_substep();
  }
  rigid.finish();
  EXPECT_NEAR(fall_speed(), 0.2, 1e-7);
  EXPECT_NEAR(ball_.getCenterOfMassPosition().y(), -0.005 * (0.05 + 0.1 + 0.15 + 0.2), 1e-7);
  EXPECT_NEAR(ball_.getCenterOfMassPosition().x(), 0.02, 1e-7);
}

// All cloth has stopped after the first substep.
TEST_F(FallingBall, GoesThroughTheSubstepsThatAreLeft) {
  RigidSubsteps rigid({MovableObject(&ball_)}, kWholeStep, kSubsteps);
  rigid.share_out_gravity(0, nullptr);
  rigid.begin_substep();
  rigid.end_substep();
  rigid.finish();
  EXPECT_NEAR(fall_speed(), 0.2, 1e-7);
  EXPECT_NEAR(ball_.getCenterOfMassPosition().x(), 0.02, 1e-7);
}

TEST_F(FallingBall, IsNotAcceleratedWhereItCannotMove) {
  ball_.setLinearFactor({1, 0, 1});
  ball_.setLinearVelocity({1, 0, 0});
  RigidSubsteps rigid({MovableObject(&ball_)}, kWholeStep, kSubsteps);
  rigid.share_out_gravity(0, nullptr);
  rigid.begin_substep();
  EXPECT_EQ(fall_speed(), 0);
}

}  // namespace
}  // namespace weft::bridge
