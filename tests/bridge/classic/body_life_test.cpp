// Laws belong to a body, not to its address.
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/deformable/deformable_world.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
namespace {

constexpr double kBodyLifeTimeStep = 1.0 / 128;  // [s] exact in single precision
const std::vector<forces::LawSpecification> kBodyLifeGravity{
    {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}}};
const std::vector<forces::LawSpecification> kSprings{{"tension", {}, {{"stiffness", {100.0}}}}};

ClothMesh body_cloth(double height = 0.0) {
  return make_cloth_grid({.nodes = {4, 4}, .center = {0, height, 0}, .total_mass = 0.1});
}

/// Bodies that all have the same address.
class Place {
 public:
  btSoftBody& make(btSoftBodyWorldInfo& info, const ClothMesh& mesh) {
    std::vector<btVector3> places;
    std::vector<btScalar> masses;
    for (int i = 0; i < mesh.num_nodes(); ++i) {
      const Vector3<btScalar> x = mesh.rest_positions.col(i).cast<btScalar>();
      places.emplace_back(x[0], x[1], x[2]);
      masses.push_back(static_cast<btScalar>(mesh.masses[i]));
    }
    return *::new (memory_) btSoftBody(&info, mesh.num_nodes(), places.data(), masses.data());
  }

 private:
  alignas(btSoftBody) std::byte memory_[sizeof(btSoftBody)];
};

TEST(BodyLife, BodyAtTheAddressOfADeletedOneHasNoLaws) {
  SoftWorld world({});
  Place place;
  for (const bool is_fast : {false, true}) {
    btSoftBody& first = place.make(world.info(), body_cloth());
    world.world().addSoftBody(&first);
    if (is_fast) {
      ASSERT_FALSE(world.solver().attach_fast(first, body_cloth(), kSprings));
    } else {
      world.solver().attach(first, body_cloth(), kBodyLifeGravity);
    }
    world.solver().set_cloth_contact(first, {.with_others = true});
    world.step(kBodyLifeTimeStep);
    world.world().removeSoftBody(&first);
    first.~btSoftBody();

    btSoftBody& second = place.make(world.info(), body_cloth());
    EXPECT_EQ(&second, &first);
    EXPECT_FALSE(world.solver().has_laws(second));
    EXPECT_FALSE(world.solver().is_fast(second));
    world.world().addSoftBody(&second);
    world.step(kBodyLifeTimeStep);
    EXPECT_EQ(second.m_nodes[0].m_v.y(), btScalar(0));
    world.solver().attach(second, body_cloth(), kBodyLifeGravity);
    world.step(kBodyLifeTimeStep);
    EXPECT_LT(second.m_nodes[0].m_v.y(), btScalar(0));
    world.world().removeSoftBody(&second);
    second.~btSoftBody();
    world.step(kBodyLifeTimeStep);
  }
}

TEST(BodyLife, BodyThatWasInNoWorldCanBeDeletedWithItsLaws) {
  DeformableWorld deformable({});
  SoftWorld world({});
  Place place, other_place;
  btSoftBody& first = place.make(world.info(), body_cloth());
  btSoftBody& other_first = other_place.make(deformable.info(), body_cloth());
  world.solver().attach(first, body_cloth(), kBodyLifeGravity);
  deformable.forces().attach(other_first, body_cloth(), kBodyLifeGravity);
  for (btSoftBody* body : {&first, &other_first}) body->~btSoftBody();
  btSoftBody& second = place.make(world.info(), body_cloth());
  btSoftBody& other_second = other_place.make(deformable.info(), body_cloth());
  EXPECT_FALSE(world.solver().has_laws(second));
  EXPECT_FALSE(deformable.forces().has_laws(other_second));
  world.step(kBodyLifeTimeStep);
  deformable.step(kBodyLifeTimeStep);
  for (btSoftBody* body : {&second, &other_second}) body->~btSoftBody();
}

TEST(BodyLife, BodyThatComesBackToItsWorldHasItsLaws) {
  SoftWorld world({});
  const auto slow = make_cloth_body(world.info(), body_cloth(), {});
  const auto fast = make_cloth_body(world.info(), body_cloth(3), {});
  for (btSoftBody* body : {slow.get(), fast.get()}) world.world().addSoftBody(body);
  world.solver().attach(*slow, body_cloth(), kBodyLifeGravity);
  ASSERT_FALSE(
      world.solver().attach_fast(*fast, body_cloth(3), {kSprings[0], kBodyLifeGravity[0]}));
  world.step(kBodyLifeTimeStep);
  for (btSoftBody* body : {slow.get(), fast.get()}) world.world().removeSoftBody(body);
  const btVector3 left = fast->m_nodes[0].m_x;
  for (int step = 0; step < 3; ++step) world.step(kBodyLifeTimeStep);
  EXPECT_EQ(fast->m_nodes[0].m_x, left);
  for (btSoftBody* body : {slow.get(), fast.get()}) {
    EXPECT_TRUE(world.solver().has_laws(*body));
    world.world().addSoftBody(body);
  }
  world.step(kBodyLifeTimeStep);
  EXPECT_TRUE(world.solver().is_fast(*fast));
  for (const btSoftBody* body : {slow.get(), fast.get()}) {
    // Two steps of fall, in which Bullet derives velocities from single-precision places.
    EXPECT_NEAR(static_cast<double>(body->m_nodes[0].m_v.y()), -2 * 9.81 * kBodyLifeTimeStep, 1e-3);
  }
  for (btSoftBody* body : {slow.get(), fast.get()}) world.world().removeSoftBody(body);
}

TEST(BodyLife, BodyMayOutliveItsSolver) {
  SoftWorld later({});
  std::unique_ptr<btSoftBody> body;
  {
    SoftWorld world({});
    body = make_cloth_body(later.info(), body_cloth(), {});
    world.solver().attach(*body, body_cloth(), kBodyLifeGravity);
  }
  later.world().addSoftBody(body.get());
  later.solver().attach(*body, body_cloth(), kBodyLifeGravity);
  later.step(kBodyLifeTimeStep);
  later.world().removeSoftBody(body.get());
}

TEST(BodyLife, TheShapeOfABodyAnswersAsBefore) {
  SoftWorld world({});
  const auto body = make_cloth_body(world.info(), body_cloth(), {.collision_margin = 0.25});
  btCollisionShape* const before = body->getCollisionShape();
  before->setUserIndex(7);
  btTransform place;
  place.setIdentity();
  btVector3 low, high;
  before->getAabb(place, low, high);
  world.solver().attach(*body, body_cloth(), kBodyLifeGravity);
  btCollisionShape* const after = body->getCollisionShape();
  btVector3 low_after, high_after;
  after->getAabb(place, low_after, high_after);
  EXPECT_EQ(low, low_after);
  EXPECT_EQ(high, high_after);
  EXPECT_EQ(after->getUserIndex(), 7);
  EXPECT_EQ(after->getMargin(), btScalar(0.25));
  after->setMargin(btScalar(0.5));
  EXPECT_EQ(before->getMargin(), btScalar(0.5));
  EXPECT_EQ(after->getShapeType(), SOFTBODY_SHAPE_PROXYTYPE);
}

/// A world with Bullet's own solver.
struct PlainWorld {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &constraints, &configuration};
};

TEST(BodyLife, BodyOfAWorldWithAnotherSolverIsRefused) {
  PlainWorld plain;
  SoftWorld world({});
  DeformableWorld deformable({});
  const auto body = make_cloth_body(plain.world.getWorldInfo(), body_cloth(), {});
  plain.world.addSoftBody(body.get());
  EXPECT_THROW(world.solver().attach(*body, body_cloth(), kBodyLifeGravity), InvalidArgument);
  EXPECT_THROW((void)world.solver().attach_fast(*body, body_cloth(), kSprings), InvalidArgument);
  EXPECT_THROW(world.solver().set_cloth_contact(*body, {.with_others = true}), InvalidArgument);
  EXPECT_THROW(deformable.forces().attach(*body, body_cloth(), kBodyLifeGravity), InvalidArgument);
  EXPECT_FALSE(world.solver().has_laws(*body));
  plain.world.removeSoftBody(body.get());
  EXPECT_NO_THROW(world.solver().attach(*body, body_cloth(), kBodyLifeGravity));
}

TEST(BodyLife, BodyWithLawsIsRefusedByAWorldThatWouldNotKnowThem) {
  PlainWorld plain;
  SoftWorld world({});
  const auto body = make_cloth_body(plain.world.getWorldInfo(), body_cloth(), {});
  world.solver().attach(*body, body_cloth(), kBodyLifeGravity);
  EXPECT_THROW(plain.world.addSoftBody(body.get()), InvalidArgument);
  plain.world.removeSoftBody(body.get());
  plain.world.stepSimulation(btScalar(kBodyLifeTimeStep), 0);
  world.solver().detach(*body);
  EXPECT_NO_THROW(plain.world.addSoftBody(body.get()));
  plain.world.stepSimulation(btScalar(kBodyLifeTimeStep), 0);
  plain.world.removeSoftBody(body.get());
}

}  // namespace
}  // namespace weft::bridge
