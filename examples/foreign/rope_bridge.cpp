// After games with bridges: two ropes, planks on anchors between them, and a box that drops on the middle.
#include <array>
#include <memory>
#include <vector>

#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "longest_stretch.hpp"
#ifdef WITH_WEFT
#include <weft/weft.hpp>
#endif

namespace {

constexpr int kPlanks = 9;
constexpr int kRopeNodes = 2 * kPlanks + 3;

std::unique_ptr<btRigidBody> make_box(btCollisionShape& shape, double mass,
                                      const btVector3& place) {
  btVector3 inertia(0, 0, 0);
  shape.calculateLocalInertia(btScalar(mass), inertia);
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape, inertia);
  info.m_startWorldTransform.setOrigin(place);
  return std::make_unique<btRigidBody>(info);
}

}  // namespace

int main(int argc, char** argv) {
#ifdef WITH_WEFT
  weft::bridge::AdoptingSolver soft_bodies;
#else
  btDefaultSoftBodySolver soft_bodies;
#endif
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration,
                                 &soft_bodies);
  world.setGravity(btVector3(0, btScalar(-9.81), 0));
  world.getWorldInfo().m_gravity = world.getGravity();

  const btScalar length = 4;
  std::array<btSoftBody*, 2> ropes{};
  for (int side = 0; side < 2; ++side) {
    const btScalar z = side == 0 ? btScalar(-0.5) : btScalar(0.5);
    ropes[side] = btSoftBodyHelpers::CreateRope(world.getWorldInfo(), btVector3(0, 0, z),
                                                btVector3(length, 0, z), kRopeNodes - 2, 1 + 2);
    ropes[side]->setTotalMass(2);
    ropes[side]->m_cfg.piterations = 15;
    ropes[side]->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
    world.addSoftBody(ropes[side]);
  }
  btBoxShape plank(btVector3(btScalar(0.15), btScalar(0.03), btScalar(0.5)));
  std::vector<std::unique_ptr<btRigidBody>> planks;
  for (int p = 0; p < kPlanks; ++p) {
    const int node = 2 * p + 2;
    const btScalar x = length * btScalar(node) / (kRopeNodes - 1);
    planks.push_back(make_box(plank, 0.5, btVector3(x, 0, 0)));
    world.addRigidBody(planks.back().get());
    for (btSoftBody* const rope : ropes) rope->appendAnchor(node, planks.back().get(), true);
  }
  btBoxShape cube(btVector3(btScalar(0.4), btScalar(0.1), btScalar(0.3)));
  const auto load = make_box(cube, 2, btVector3(2, btScalar(0.25), 0));
  world.addRigidBody(load.get());

  for (int step = 0; step < 600; ++step) world.stepSimulation(btScalar(1) / 60, 0);
  const double stretch = std::max(longest_stretch(*ropes[0]), longest_stretch(*ropes[1]));
  const btVector3 place = load->getWorldTransform().getOrigin();
  const btScalar sag = -planks[kPlanks / 2]->getWorldTransform().getOrigin().y();
  const bool is_on_bridge = place.y() > -sag && sag < 2 && sag > 0;

  world.removeRigidBody(load.get());
  for (const auto& one : planks) world.removeRigidBody(one.get());
  for (btSoftBody* const rope : ropes) {
    world.removeSoftBody(rope);
    delete rope;
  }
  return end_with("a box on a bridge of ropes and planks", stretch, is_on_bridge, argc, argv);
}
