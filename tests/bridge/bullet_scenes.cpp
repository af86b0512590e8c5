#include "tests/bridge/bullet_scenes.hpp"

#include <cstdlib>

#include <BulletSoftBody/btSoftBodyHelpers.h>

namespace weft::bridge::testing {
namespace {

std::unique_ptr<btCollisionShape> box(btScalar half_extent) {
  return std::make_unique<btBoxShape>(btVector3(half_extent, half_extent, half_extent));
}

void add_floor(PlainWorld& world) {
  world.add_rigid(std::make_unique<btBoxShape>(btVector3(50, 1, 50)), 0, btVector3(0, -3, 0));
}

void patch_with_rigid_bodies(PlainWorld& world) {
  const btScalar s = 4;
  btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(
      world.world.getWorldInfo(), btVector3(-s, 0, -s), btVector3(+s, 0, -s), btVector3(-s, 0, +s),
      btVector3(+s, 0, +s), 17, 17, 1 + 2 + 4 + 8, true);
  cloth->getCollisionShape()->setMargin(btScalar(0.5));
  btSoftBody::Material* material = cloth->appendMaterial();
  material->m_kLST = btScalar(0.4);
  cloth->generateBendingConstraints(2, material);
  cloth->setTotalMass(50);
  cloth->m_cfg.kDP = btScalar(0.01);
  world.add(cloth);
  for (int i = 0; i < 4; ++i) {
    world.add_rigid(box(btScalar(0.5)), 1,
                    btVector3(btScalar(i - 1.5), btScalar(2 + i), btScalar(0.3 * i)));
  }
}

void ropes_with_boxes(PlainWorld& world) {
  for (int i = 0; i < 2; ++i) {
    const btScalar x = static_cast<btScalar>(3 * i);
    btSoftBody* rope = btSoftBodyHelpers::CreateRope(
        world.world.getWorldInfo(), btVector3(x, 4, -2), btVector3(x, 4, 4), 12, 1);
    rope->setTotalMass(4);
    rope->m_cfg.piterations = 4;
    world.add(rope);
    btRigidBody* weight = world.add_rigid(box(btScalar(0.6)), 20, btVector3(x, 4, 4));
    rope->appendAnchor(rope->m_nodes.size() - 1, weight);
  }
}

void pressurised_ellipsoid(PlainWorld& world) {
  add_floor(world);
  btSoftBody* ball = btSoftBodyHelpers::CreateEllipsoid(
      world.world.getWorldInfo(), btVector3(0, 3, 0), btVector3(2, 2, 2), 200);
  ball->m_materials[0]->m_kLST = btScalar(0.1);
  ball->m_cfg.kDF = 1;
  ball->m_cfg.kDP = btScalar(0.001);
  ball->m_cfg.kPR = 1500;
  ball->m_cfg.kDG = btScalar(0.01);
  ball->setTotalMass(30, true);
  world.add(ball);
}

void pose_matched_body(PlainWorld& world) {
  add_floor(world);
  btSoftBody* body = btSoftBodyHelpers::CreateEllipsoid(
      world.world.getWorldInfo(), btVector3(0, 2, 0), btVector3(1, 2, 1), 120);
  body->m_materials[0]->m_kLST = btScalar(0.3);
  body->m_cfg.kDF = btScalar(0.5);
  body->m_cfg.kMT = btScalar(0.05);
  body->m_cfg.viterations = 1;
  body->randomizeConstraints();
  body->setTotalMass(10, true);
  body->setPose(false, true);
  world.add(body);
}

void cluster_body(PlainWorld& world) {
  add_floor(world);
  btSoftBody* body = btSoftBodyHelpers::CreateEllipsoid(
      world.world.getWorldInfo(), btVector3(0, 2, 0), btVector3(btScalar(1.5), 1, 1), 150);
  body->m_materials[0]->m_kLST = btScalar(0.5);
  body->m_cfg.collisions = btSoftBody::fCollision::CL_SS + btSoftBody::fCollision::CL_RS;
  body->generateBendingConstraints(2);
  body->m_cfg.piterations = 2;
  body->randomizeConstraints();
  body->setTotalMass(10, true);
  body->generateClusters(8);
  world.add(body);
}

void soft_against_soft(PlainWorld& world) {
  for (int i = 0; i < 2; ++i) {
    const btScalar s = static_cast<btScalar>(i == 0 ? 3 : 1.5);
    const btScalar y = static_cast<btScalar>(i == 0 ? 0 : 2);
    btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(
        world.world.getWorldInfo(), btVector3(-s, y, -s), btVector3(+s, y, -s),
        btVector3(-s, y, +s), btVector3(+s, y, +s), 13, 13, i == 0 ? 15 : 0, true);
    cloth->m_materials[0]->m_kLST = btScalar(0.4);
    cloth->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    cloth->m_cfg.piterations = 4;
    cloth->generateBendingConstraints(2);
    cloth->setTotalMass(5);
    world.add(cloth);
  }
}

void append(const btVector3& v, std::vector<btScalar>& values) {
  values.insert(values.end(), {v.x(), v.y(), v.z()});
}

}  // namespace

PlainWorld::PlainWorld(btSoftBodySolver* solver)
    : world(&dispatcher, &broadphase, &constraint_solver, &configuration, solver) {
  world.setGravity(btVector3(0, -10, 0));
  world.getWorldInfo().m_gravity.setValue(0, -10, 0);
  world.getWorldInfo().m_sparsesdf.Initialize();
}

PlainWorld::~PlainWorld() {
  for (const auto& body : soft_bodies_) world.removeSoftBody(body.get());
  for (const auto& body : rigid_bodies_) world.removeRigidBody(body.get());
}

btSoftBody* PlainWorld::add(btSoftBody* body) {
  soft_bodies_.emplace_back(body);
  world.addSoftBody(body);
  return body;
}

btRigidBody* PlainWorld::add_rigid(std::unique_ptr<btCollisionShape> shape, btScalar mass,
                                   const btVector3& at) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
  info.m_startWorldTransform.setIdentity();
  info.m_startWorldTransform.setOrigin(at);
  rigid_bodies_.push_back(std::make_unique<btRigidBody>(info));
  shapes_.push_back(std::move(shape));
  world.addRigidBody(rigid_bodies_.back().get());
  return rigid_bodies_.back().get();
}

const std::vector<BulletScene>& bullet_scenes() {
  static const std::vector<BulletScene> kScenes = {
      {"patch_with_rigid_bodies", &patch_with_rigid_bodies},
      {"ropes_with_boxes", &ropes_with_boxes},
      {"pressurised_ellipsoid", &pressurised_ellipsoid},
      {"pose_matched_body", &pose_matched_body},
      {"cluster_body", &cluster_body},
      {"soft_against_soft", &soft_against_soft},
  };
  return kScenes;
}

std::vector<btScalar> run_scene(const BulletScene& scene, btSoftBodySolver* solver, int num_steps) {
  std::srand(1);  // Bullet's patch builder draws from rand()
  PlainWorld world(solver);
  scene.build(world);
  std::vector<btScalar> values;
  for (int step = 0; step < num_steps; ++step) {
    world.world.stepSimulation(btScalar(1) / btScalar(60), 0);
    for (int b = 0; b < world.world.getSoftBodyArray().size(); ++b) {
      const btSoftBody& body = *world.world.getSoftBodyArray()[b];
      for (int i = 0; i < body.m_nodes.size(); ++i) {
        append(body.m_nodes[i].m_x, values);
        append(body.m_nodes[i].m_v, values);
      }
    }
    for (int o = 0; o < world.world.getNumCollisionObjects(); ++o) {
      const btTransform& transform = world.world.getCollisionObjectArray()[o]->getWorldTransform();
      append(transform.getOrigin(), values);
      for (int row = 0; row < 3; ++row) append(transform.getBasis()[row], values);
    }
  }
  return values;
}

}  // namespace weft::bridge::testing
