// What Cloth::warnings() says of bodies in Bullet's world.
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include <weft/bridge/weft.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

using Kind = forces::SetUpWarning::Kind;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kMass = 0.25;  // [kg]
const forces::LawSpecification kSprings = law("tension", "stiffness", 1000.0);

/// The scene's world has the gravity of the cloth's laws in the place of its own.
std::vector<forces::SetUpWarning> warnings_of(Scene& scene, double time_step = kTimeStep) {
  return scene.solver().cloth(scene.body()).warnings(scene.world().world(), time_step);
}

std::vector<Kind> kinds_of(Scene& scene, double time_step = kTimeStep) {
  std::vector<Kind> kinds;
  for (const auto& warning : warnings_of(scene, time_step)) kinds.push_back(warning.kind);
  return kinds;
}

btTransform place(double y) {
  btTransform place = btTransform::getIdentity();
  place.setOrigin(vector(0, y, 0));
  return place;
}

TEST(ClothWarnings, AnOrdinaryClothOverABallAndGroundHasNone) {
  Scene scene(cloth(11, 1, 1, kMass), {kSprings, kGravity});
  scene.add(std::make_shared<btSphereShape>(btScalar(0.3)), 1, place(0.5));
  scene.add(std::make_shared<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0, place(0));
  EXPECT_THAT(warnings_of(scene), IsEmpty());
}

TEST(ClothWarnings, GravityOfTheWorldBesideTheLawIsNamed) {
  Scene scene(cloth(11, 1, 1, kMass), {kSprings, kGravity});
  scene.world().info().m_gravity = btVector3(0, btScalar(-9.81), 0);
  EXPECT_THAT(kinds_of(scene), ElementsAre(Kind::kGravityTwice));
}

TEST(ClothWarnings, ThinObjectsAreNamedAlsoInCompounds) {
  Scene scene(cloth(11, 1, 1, kMass), {kSprings, kGravity});
  const auto pole = box(0.01, 1, 0.01);
  const auto compound = std::make_shared<btCompoundShape>();
  compound->addChildShape(btTransform::getIdentity(), pole.get());
  scene.add(compound, 0, place(0));
  const auto warnings = warnings_of(scene);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].kind, Kind::kGapBetweenNodes);
  EXPECT_THAT(warnings[0].message, HasSubstr("Compound, object"));
}

TEST(ClothWarnings, AHeavyBodyIsNamedAndAFixedOneIsNot) {
  Scene scene(cloth(11, 1, 1, kMass), {kSprings, kGravity});
  scene.add(box(0.3, 0.3, 0.3), 0, place(0));
  EXPECT_THAT(kinds_of(scene), IsEmpty());
  scene.add(box(0.3, 0.3, 0.3), 1001 * kMass, place(-2));
  EXPECT_THAT(kinds_of(scene), ElementsAre(Kind::kMassRatio));
}

TEST(ClothWarnings, ExplicitSpringsAreHeldAgainstTheirStableStep) {
  Scene scene(cloth(11, 1, 1, kMass), {kSprings, kGravity});
  scene.solver().detach(scene.body());
  scene.solver().attach(scene.body(), cloth(11, 1, 1, kMass), {kSprings, kGravity});
  EXPECT_THAT(kinds_of(scene, 1e-4), IsEmpty());
  EXPECT_THAT(kinds_of(scene), ElementsAre(Kind::kUnstableStep));
}

TEST(ClothWarnings, OfAnEmptyHandleAreNone) {
  const Scene scene(cloth(5, 1, 1, kMass), {kSprings});
  EXPECT_THAT(Cloth().warnings(const_cast<Scene&>(scene).world().world(), kTimeStep), IsEmpty());
}

}  // namespace
}  // namespace weft::bridge
