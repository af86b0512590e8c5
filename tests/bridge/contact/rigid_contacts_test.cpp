// Tested: which face of a solid holds a node that would end inside of it.
#include <weft/bridge/contact/rigid_contacts.hpp>

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::bridge {
namespace {

constexpr double kMarginOfNodes = 0.004;  // [m]
constexpr double kHalfOfPlate = 0.008;    // [m]
constexpr double kRimOfPlate = 0.1;       // [m] from its middle

/// A thin plate, and a cloth of which one node moves while the others are far away.
class Plate {
 public:
  explicit Plate(const std::shared_ptr<btCollisionShape>& shape) : shape_(shape) {
    ClothGrid grid;
    grid.nodes = {2, 2};
    grid.size = {1, 1};
    grid.center = {0, 10, 0};
    grid.total_mass = 1;
    body_ = &world_.add(make_cloth_body(world_.info(), make_cloth_grid(grid),
                                        {.collision_margin = kMarginOfNodes}));
    object_.setCollisionShape(shape_.get());
  }
  /// The contacts of a node that goes from one point to another in a step.
  std::vector<RigidContact> contacts(const btVector3& from, const btVector3& to) {
    body_->m_nodes[0].m_q = from;
    body_->m_nodes[0].m_x = to;
    SweptNodes swept;
    swept.update(*body_);
    const btCollisionObjectWrapper wrapper(nullptr, shape_.get(), &object_,
                                           object_.getWorldTransform(), -1, -1);
    std::vector<RigidContact> found;
    add_rigid_contacts(*body_, swept, make_collider(wrapper, nullptr, 0, btScalar(1.0 / 60)),
                       btScalar(1.0 / 60), PinnedNodes::kLeftOut, found);
    return found;
  }

 private:
  SoftWorld world_{SoftWorldSettings{}};
  btSoftBody* body_ = nullptr;
  std::shared_ptr<btCollisionShape> shape_;
  btCollisionObject object_;
};

btVector3 place(double x, double y) {
  return {static_cast<btScalar>(x), static_cast<btScalar>(y), 0};
}

Plate thin_plate() {
  return Plate(std::make_shared<btBoxShape>(
      btVector3(btScalar(kRimOfPlate), btScalar(kHalfOfPlate), btScalar(kRimOfPlate))));
}

/// Expects one contact, with the upper face.
void expect_above(const std::vector<RigidContact>& found) {
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(static_cast<double>(found[0].normal.y()), 1, 1e-6);
  EXPECT_NEAR(static_cast<double>(found[0].offset), kHalfOfPlate + kMarginOfNodes, 1e-6);
}

// Two millimeters from the rim and three below the upper face the rim is nearer.
TEST(RigidContacts, HoldANodeThatIsPressedIntoAPlateByTheFaceThatItCameThrough) {
  Plate plate = thin_plate();
  const double x = kRimOfPlate - 0.002;
  expect_above(plate.contacts(place(x, kHalfOfPlate + 0.0005), place(x, kHalfOfPlate - 0.003)));
  // Farther than its margin in a step.
  expect_above(plate.contacts(place(x, kHalfOfPlate + 0.002), place(x, kHalfOfPlate - 0.006)));
}

TEST(RigidContacts, HoldANodeThatBeginsInsideByTheFaceThatIsNearestThere) {
  Plate plate = thin_plate();
  const double x = kRimOfPlate - 0.002;
  expect_above(plate.contacts(place(x, kHalfOfPlate - 0.001), place(x, kHalfOfPlate - 0.0035)));
}

TEST(RigidContacts, HoldANodeThatCameThroughTheRimByTheRim) {
  Plate plate = thin_plate();
  const double y = kHalfOfPlate - 0.001;
  const auto found = plate.contacts(place(kRimOfPlate + 0.001, y), place(kRimOfPlate - 0.0025, y));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(static_cast<double>(found[0].normal.x()), 1, 1e-6);
  EXPECT_NEAR(static_cast<double>(found[0].offset), kRimOfPlate + kMarginOfNodes, 1e-6);
}

// In front of the surface nothing has changed: the nearest point there decides.
TEST(RigidContacts, HoldANodeThatEndsOutsideByWhatIsNearestThere) {
  Plate plate(std::make_shared<btSphereShape>(btScalar(0.1)));
  const auto found = plate.contacts(place(0.08, 0.08), place(0.0735, 0.0735));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(static_cast<double>(found[0].normal.x()), 0.70710678, 1e-6);
  EXPECT_TRUE(plate.contacts(place(0.2, 0.2), place(0.199, 0.199)).empty());
}

}  // namespace
}  // namespace weft::bridge
