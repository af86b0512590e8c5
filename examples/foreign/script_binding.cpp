// After bindings for other languages (Libbulletjme, ammo.js): plain functions and handles, a world that is made without a solver.
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

struct Space {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  std::unique_ptr<btSoftBodySolver> soft_bodies;
  std::unique_ptr<btSoftRigidDynamicsWorld> world;
};

Space* create_space() {
  auto* space = new Space;
  space->soft_bodies = nullptr;
#ifdef WITH_WEFT
  space->soft_bodies = std::make_unique<weft::bridge::AdoptingSolver>();
#endif
  space->world = std::make_unique<btSoftRigidDynamicsWorld>(
      &space->dispatcher, &space->broadphase, &space->constraints, &space->configuration,
      space->soft_bodies.get());
  space->world->setGravity(btVector3(0, btScalar(-9.81), 0));
  space->world->getWorldInfo().m_gravity = space->world->getGravity();
  return space;
}

/// Nodes, links and faces one by one, as a script gives them; mass 0 pins a node.
btSoftBody* create_soft_body(Space* space, const std::vector<float>& positions,
                             const std::vector<float>& masses) {
  std::vector<btVector3> points;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    points.emplace_back(btScalar(positions[3 * i]), btScalar(positions[3 * i + 1]),
                        btScalar(positions[3 * i + 2]));
  }
  const std::vector<btScalar> weights(masses.begin(), masses.end());
  return new btSoftBody(&space->world->getWorldInfo(), static_cast<int>(points.size()),
                        points.data(), weights.data());
}

btRigidBody* create_kinematic_sphere(Space* space, btCollisionShape* shape) {
  auto* body = new btRigidBody(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, shape));
  body->setCollisionFlags(body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  body->setActivationState(DISABLE_DEACTIVATION);
  space->world->addRigidBody(body);
  return body;
}

void delete_space(Space* space, btSoftBody* cloth, btRigidBody* head) {
  space->world->removeSoftBody(cloth);
  space->world->removeRigidBody(head);
  delete cloth;
  delete head;
  delete space;
}

constexpr int kSide = 17;

}  // namespace

int main(int argc, char** argv) {
  Space* const space = create_space();
  std::vector<float> positions;
  const std::vector<float> masses(kSide * kSide, 0.2F / (kSide * kSide));
  for (int node = 0; node < kSide * kSide; ++node) {
    positions.insert(positions.end(), {0.06F * static_cast<float>(node % kSide - kSide / 2), 0.3F,
                                       0.06F * static_cast<float>(node / kSide - kSide / 2)});
  }
  btSoftBody* const cloth = create_soft_body(space, positions, masses);
  for (int node = 0; node < kSide * kSide; ++node) {
    const bool has_right = node % kSide + 1 < kSide;
    const bool has_next = node / kSide + 1 < kSide;
    if (has_right) cloth->appendLink(node, node + 1);
    if (has_next) cloth->appendLink(node, node + kSide);
    if (!has_right || !has_next) continue;
    cloth->appendLink(node, node + kSide + 1);
    cloth->appendFace(node, node + 1, node + kSide + 1);
    cloth->appendFace(node, node + kSide + 1, node + kSide);
  }
  cloth->m_cfg.piterations = 8;
  cloth->getCollisionShape()->setMargin(btScalar(0.02));
  space->world->addSoftBody(cloth);
  btSphereShape shape(btScalar(0.25));
  btRigidBody* const head = create_kinematic_sphere(space, &shape);

  btTransform place = btTransform::getIdentity();
  for (int step = 0; step < 300; ++step) {
    // After two seconds the head walks off at 0.3 m/s, and the cloth goes with it.
    if (step > 120) place.setOrigin(btVector3(btScalar(0.005) * btScalar(step - 120), 0, 0));
    head->setWorldTransform(place);
    space->world->stepSimulation(btScalar(1) / 60, 0);
  }
  const btVector3 top = cloth->m_nodes[kSide * kSide / 2].m_x;
  const bool is_on_head =
      top.y() > btScalar(0.1) && (top - place.getOrigin()).length() < btScalar(0.35);
  const double stretch = longest_stretch(*cloth);
  delete_space(space, cloth, head);
  return end_with("a cloth on a head that walks", stretch, is_on_head, argc, argv);
}
