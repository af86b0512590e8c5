// How far moved pins pull pressed cloth in a step.
#include <weft/bridge/implicit/substeps/pin_pull.hpp>

#include <array>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <gtest/gtest.h>

namespace weft::bridge {
namespace {

/// Four nodes, of which the first and the last are pins.
class PulledCloth : public testing::Test {
 protected:
  PulledCloth() {
    contacts_[0].node = contacts_[1].node = 1;
    contacts_[2].node = 2;
    contacts_[0].object = contacts_[2].object = &box_;
    contacts_[1].object = &table_;
  }
  [[nodiscard]] btScalar pull(const RigidContact& contact, const Vector3<btScalar>& way) const {
    return PinPull(kPins, ends_, starts_, contacts_).on(contact.node, way);
  }
  static constexpr std::array<int, 2> kPins{0, 3};
  btCollisionObject box_;
  btCollisionObject table_;
  std::array<RigidContact, 3> contacts_;
  Matrix3X<btScalar> ends_ = Matrix3X<btScalar>::Zero(3, 4);
  Matrix3X<btScalar> starts_ = Matrix3X<btScalar>::Zero(3, 4);
};

TEST_F(PulledCloth, IsPulledByThePinThatMovesTheMost) {
  starts_(0, 0) = btScalar(0.25);
  starts_(0, 3) = btScalar(-0.5);
  EXPECT_EQ(pull(contacts_[0], Vector3<btScalar>::Zero()), btScalar(0.5));
}

TEST_F(PulledCloth, IsNotWhereItMovesWithThePins) {
  starts_(0, 0) = btScalar(0.25);
  EXPECT_EQ(pull(contacts_[0], Vector3<btScalar>(btScalar(0.25), 0, 0)), 0);
  EXPECT_EQ(pull(contacts_[0], Vector3<btScalar>(btScalar(-0.25), 0, 0)), btScalar(0.5));
}

// Pins that rounding moves do not divide the steps of cloth that slides.
TEST_F(PulledCloth, IsPulledLittleByAPinThatMovesLittle) {
  starts_(0, 0) = btScalar(1e-9);
  EXPECT_LE(pull(contacts_[0], Vector3<btScalar>(0, 1, 0)), btScalar(2.001e-9));
}

TEST_F(PulledCloth, IsOnlyWhereSomethingIsBehindIt) {
  starts_(0, 0) = btScalar(0.25);
  EXPECT_EQ(pull(contacts_[2], Vector3<btScalar>::Zero()), 0);
}

TEST_F(PulledCloth, IsNotWithoutPinsThatMove) {
  starts_(0, 1) = btScalar(0.25);  // a free node
  EXPECT_EQ(pull(contacts_[0], Vector3<btScalar>(1, 0, 0)), 0);
  ends_.resize(3, 2);  // of other nodes
  starts_(0, 0) = btScalar(0.25);
  EXPECT_EQ(pull(contacts_[0], Vector3<btScalar>::Zero()), 0);
}

}  // namespace
}  // namespace weft::bridge
