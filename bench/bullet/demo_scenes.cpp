// Scenes of the kinds of Bullet's soft-body demo (examples/SoftDemo), with meshes and sizes of their own.
#include "bench/bullet/demo_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "bench/bullet/demo_meshes.hpp"

namespace weft::bench {
namespace {

using Flags = btSoftBody::fCollision;

constexpr int kCorners = 1 + 2 + 4 + 8;

btSoftBody* patch(DemoWorld& world, double half, double height, int n, int pinned) {
  return btSoftBodyHelpers::CreatePatch(world.info(), vector(-half, height, -half),
                                        vector(half, height, -half), vector(-half, height, half),
                                        vector(half, height, half), n, n, pinned, true);
}

btSoftBody& clustered(DemoWorld& world, btSoftBody* body, const btVector3& place, int clusters) {
  body->m_cfg.piterations = 2;
  body->m_cfg.kDF = 1;
  body->m_cfg.collisions = Flags::CL_SS + Flags::CL_RS;
  body->translate(place);
  body->setTotalMass(50, true);
  body->generateClusters(clusters);
  return world.add(body);
}

void cloth(DemoWorld& world) {
  btSoftBody* const body = patch(world, 8, 0, 31, kCorners);
  body->getCollisionShape()->setMargin(btScalar(0.5));
  body->m_materials[0]->m_kLST = btScalar(0.4);
  bend(*body, 0.4);
  body->setTotalMass(150);
  world.add(body);
  world.add_falling_boxes(10);
}

btSoftBody& ball(DemoWorld& world, double height) {
  btSoftBody* const body =
      btSoftBodyHelpers::CreateEllipsoid(world.info(), vector(0, height, 0), vector(3, 3, 3), 512);
  body->setTotalMass(30, true);
  return world.add(body);
}

void pressure(DemoWorld& world) {
  btSoftBody& body = ball(world, 6);
  body.m_materials[0]->m_kLST = btScalar(0.1);
  body.m_cfg.kDF = 1;
  body.m_cfg.kDP = btScalar(0.001);
  body.m_cfg.kPR = 2500;
  world.add_stair(10);
}

void volume(DemoWorld& world) {
  btSoftBody& body = ball(world, 6);
  body.m_materials[0]->m_kLST = btScalar(0.45);
  body.m_cfg.kVC = 20;
  body.setPose(true, false);
  world.add_stair(10);
}

void ropes(DemoWorld& world) {
  for (int i = 0; i < 15; ++i) {
    btSoftBody* const rope = btSoftBodyHelpers::CreateRope(world.info(), vector(-10, 0, 0.25 * i),
                                                           vector(10, 0, 0.25 * i), 16, 1 + 2);
    rope->m_cfg.piterations = 4;
    rope->m_materials[0]->m_kLST = btScalar(0.1 + 0.9 * i / 14);
    rope->setTotalMass(20);
    world.add(rope);
  }
}

void anchored_ropes(DemoWorld& world) {
  btRigidBody& box =
      world.add_rigid(std::make_unique<btBoxShape>(vector(2, 6, 2)), 50, vector(12, 8, 0));
  for (const double z : {-1.0, 1.0}) {
    btSoftBody* const rope =
        btSoftBodyHelpers::CreateRope(world.info(), vector(0, 8, z), vector(10, 8, z), 8, 1);
    rope->setTotalMass(50);
    world.add(rope).appendAnchor(rope->m_nodes.size() - 1, &box);
  }
}

void anchored_cloth(DemoWorld& world) {
  btSoftBody& body = world.add(patch(world, 4, 6, 9, 4 + 8));
  btRigidBody& box =
      world.add_rigid(std::make_unique<btBoxShape>(vector(4, 1, 3)), 20, vector(0, 6, -7.5));
  body.appendAnchor(0, &box);
  body.appendAnchor(8, &box);
}

void impact(DemoWorld& world) {
  btSoftBody* const rope =
      btSoftBodyHelpers::CreateRope(world.info(), vector(0, 0, 0), vector(0, -1, 0), 0, 1);
  rope->m_cfg.kCHR = btScalar(0.5);
  world.add(rope);
  world.add_rigid(std::make_unique<btBoxShape>(vector(2, 2, 2)), 10, vector(0, 20, 0));
}

void on_capsule(DemoWorld& world) {
  auto capsule = std::make_unique<btCapsuleShapeX>(btScalar(1), btScalar(5));
  world.add_rigid(std::move(capsule), 0, vector(0, 4, 0)).setFriction(btScalar(0.8));
  btSoftBody* const body = patch(world, 4, 6, 20, 0);
  body->setTotalMass(btScalar(0.1));
  body->m_cfg.piterations = 10;
  world.add(body);
}

void meeting_bodies(DemoWorld& world, bool are_animals) {
  for (int i = 0; i < 3; ++i) {
    btSoftBody* const body = are_animals ? animal(world, 2) : torus(world);
    if (!are_animals) body->generateBendingConstraints(2);
    body->m_cfg.piterations = 2;
    body->m_cfg.collisions |= Flags::VF_SS;
    body->transform(btTransform(btQuaternion(btScalar(1.5 * (i % 2)), btScalar(0.2 * i), 0),
                                vector(0, 6 * i - 4, 0.5 * i)));
    body->setTotalMass(50, true);
    world.add(body);
  }
}

void cloth_on_cloth(DemoWorld& world) {
  btSoftBody* const lower = patch(world, 8, 0, 15, kCorners);
  lower->m_materials[0]->m_kLST = btScalar(0.4);
  lower->m_cfg.collisions |= Flags::VF_SS;
  lower->setTotalMass(150);
  world.add(lower);
  btSoftBody* const upper = patch(world, 4, 8, 7, 0);
  bend(*upper, 0.1);
  upper->m_materials[0]->m_kLST = btScalar(0.5);
  upper->m_cfg.collisions |= Flags::VF_SS;
  upper->setTotalMass(150);
  world.add(upper);
}

void flyers(DemoWorld& world) {
  for (int i = 0; i < 50; ++i) {
    btSoftBody* const body = patch(world, 2, 10, 6, 0);
    body->generateBendingConstraints(2, body->appendMaterial());
    body->m_cfg.kLF = btScalar(0.004);
    body->m_cfg.kDG = btScalar(0.0003);
    body->m_cfg.aeromodel = btSoftBody::eAeroModel::V_TwoSided;
    body->transform(btTransform(btQuaternion(btScalar(0.4), btScalar(-0.4), 0),
                                vector(i % 7 * 5 - 15, i / 7 * 3, i % 5 * 6)));
    body->setTotalMass(btScalar(0.1));
    world.add(body);
  }
}

void curtains(DemoWorld& world) {
  for (int i = 0; i < 5; ++i) {
    const double x = 10.5 * i - 25;
    btSoftBody* const body = btSoftBodyHelpers::CreatePatch(
        world.info(), vector(x, 15, 0), vector(x + 10, 15, 0), vector(x, -5, 0),
        vector(x + 10, -5, 0), 10, 30, 1 + 2, true);
    body->getCollisionShape()->setMargin(btScalar(0.5));
    bend(*body, 0.0004);
    body->m_cfg.kLF = btScalar(0.05);
    body->m_cfg.kDG = btScalar(0.01);
    body->m_cfg.piterations = 2;
    body->m_cfg.aeromodel = btSoftBody::eAeroModel::V_TwoSidedLiftDrag;
    body->setWindVelocity(vector(4, -12, -25));
    body->setTotalMass(2);
    btSoftBodyHelpers::ReoptimizeLinkOrder(body);
    world.add(body);
  }
}

void sliding_boxes(DemoWorld& world) {
  for (int i = 0; i < 20; ++i) {
    btVector3 corners[8];
    for (int c = 0; c < 8; ++c) {
      corners[c] = vector(2.5 * i - 25 + (c & 1) * 2, -9.5 + (c >> 1 & 1) * 2, 30 + (c >> 2) * 2);
    }
    btSoftBody* const body = btSoftBodyHelpers::CreateFromConvexHull(world.info(), corners, 8);
    body->generateBendingConstraints(2);
    body->m_cfg.kDF = btScalar(0.005 * (i + 1));
    body->addVelocity(vector(0, 0, -10));
    world.add(body);
  }
}

void sticks(DemoWorld& world) {
  for (int i = 0; i < 256; ++i) {
    const double x = i % 16 * 0.6 - 4.8;
    const double z = i / 16 * 0.6 - 4.8;
    btSoftBody* const stick = btSoftBodyHelpers::CreateRope(
        world.info(), vector(x, -10, z), vector(x + 0.001 * i / 256, -6, z), 4, 1);
    stick->m_cfg.kDP = btScalar(0.005);
    stick->m_cfg.kCHR = btScalar(0.1);
    for (int distance = 2; distance <= 4; ++distance) stick->generateBendingConstraints(distance);
    stick->setMass(1, 0);
    stick->setTotalMass(btScalar(0.01));
    world.add(stick);
  }
  btRigidBody& roller =
      world.add_rigid(std::make_unique<btSphereShape>(btScalar(2)), 3, vector(-12, -7, 0));
  roller.setLinearVelocity(vector(6, 0, 0));
}

void soft_torus(DemoWorld& world, bool matches_pose) {
  btSoftBody* const body = torus(world);
  if (!matches_pose) body->generateBendingConstraints(2);
  body->m_cfg.piterations = 2;
  body->translate(vector(0, 4, 0));
  body->setTotalMass(50, true);
  if (matches_pose) {
    body->m_cfg.kMT = btScalar(0.05);
    body->m_materials[0]->m_kLST = btScalar(0.1);
    body->setPose(false, true);
  }
  world.add(body);
  world.add_stair(6);
}

void lone_animal(DemoWorld& world, bool matches_pose) {
  btSoftBody* const body = animal(world, 3);
  body->setTotalMass(100, true);
  if (matches_pose) {
    body->m_cfg.kMT = btScalar(0.05);
    body->setPose(false, true);
  }
  world.add(body);
}

/// Cuts along the plane x = 0.1.
struct CutPlane : btSoftBody::ImplicitFn {
  btScalar Eval(const btVector3& x) override { return x.x() - btScalar(0.1); }
};

void cut_sheet(DemoWorld& world) {
  btSoftBody& body = world.add(patch(world, 6, 2, 16, kCorners));
  body.m_cfg.piterations = 1;
  CutPlane plane;
  body.refine(&plane, btScalar(1e-4), true);
}

void clusters_deform(DemoWorld& world) {
  clustered(world, torus(world), vector(0, 0, 0), 8);
}

void clusters_under_boxes(DemoWorld& world) {
  btSoftBody* const body = patch(world, 8, 0, 17, kCorners);
  bend(*body, 0.4);
  body->m_cfg.kDF = 1;
  body->m_cfg.collisions = Flags::CL_SS + Flags::CL_RS;
  body->getCollisionShape()->setMargin(btScalar(0.05));
  body->setTotalMass(50);
  body->generateClusters(0);
  world.add(body);
  world.add_falling_boxes(10);
}

void clusters_meet(DemoWorld& world) {
  for (int i = 0; i < 3; ++i) clustered(world, torus(world), vector(1.5 * i, 4 * i - 4, 0), 16);
}

void clusters_jointed(DemoWorld& world, bool is_hinge) {
  btSoftBody& body = clustered(world, torus(world), vector(0, 0, 0), 16);
  btRigidBody& plate =
      world.add_rigid(std::make_unique<btBoxShape>(vector(5, 1, 5)), 50, vector(0, 6, 0));
  if (is_hinge) {
    btSoftBody::AJoint::Specs joint;
    joint.axis = vector(0, 0, 1);
    body.appendAngularJoint(joint, &plate);
  } else {
    btSoftBody::LJoint::Specs joint;
    joint.position = vector(0, 4, 0);
    body.appendLinearJoint(joint, &plate);
  }
}

/// Bodies joined to each other: two wheels, or a body and its four wheels.
void clusters_combined(DemoWorld& world, int num_wheels) {
  btSoftBody& middle = clustered(world, torus(world), vector(0, 4, 0), 8);
  for (int i = 0; i < num_wheels; ++i) {
    const btVector3 place = vector(i % 2 * 12 - 6, 4, i / 2 * 12 - (num_wheels > 1 ? 6 : 0));
    btSoftBody& wheel = clustered(world, torus(world), place, 8);
    btSoftBody::LJoint::Specs joint;
    joint.position = place / 2 + vector(0, 2, 0);
    middle.appendLinearJoint(joint, &wheel);
  }
}

void clusters_carry_plate(DemoWorld& world) {
  btRigidBody& plate =
      world.add_rigid(std::make_unique<btCylinderShape>(vector(8, 1, 8)), 50, vector(0, 6, 0));
  for (int i = 0; i < 3; ++i) {
    btSoftBody* const leg =
        btSoftBodyHelpers::CreateEllipsoid(world.info(), vector(0, 0, 0), vector(3, 3, 3), 256);
    leg->m_cfg.kVC = 20;
    btSoftBody& body =
        clustered(world, leg, vector(6 * std::cos(2.1 * i), 0, 6 * std::sin(2.1 * i)), 1);
    btSoftBody::LJoint::Specs joint;
    joint.erp = btScalar(0.5);
    joint.position = body.clusterCom(0);
    body.appendLinearJoint(joint, &plate);
  }
}

void clusters_stack(DemoWorld& world, bool with_plates) {
  for (int i = 0; i < 8; ++i) {
    const double height = -8 + 3 * i;
    if (with_plates && i % 2 == 1) {
      world.add_plate(50, height);
    } else {
      clustered(world, torus(world), vector(0, height, 0), 16);
    }
  }
}

void tetrahedra(DemoWorld& world, int n, double size, bool has_clusters) {
  btSoftBody* const body = tetrahedral_cube(world, n, size);
  body->translate(vector(-size / 2, 4, -size / 2));
  body->setVolumeMass(100);
  body->m_cfg.piterations = 1;
  if (has_clusters) {
    body->m_cfg.collisions = Flags::CL_SS + Flags::CL_RS;
    body->m_cfg.kDF = 10;
    body->generateClusters(16);
  }
  world.add(body);
}

}  // namespace

DemoWorld::DemoWorld(btSoftBodySolver* solver)
    : world(&dispatcher, &broadphase, &constraints, &configuration, solver) {
  world.setGravity(vector(0, -10, 0));
  info().m_gravity = world.getGravity();
  info().air_density = btScalar(1.2);
  info().water_density = 0;
  info().m_sparsesdf.Initialize();
  add_rigid(std::make_unique<btBoxShape>(vector(100, 5, 100)), 0, vector(0, kFloor - 5, 0));
}

DemoWorld::~DemoWorld() {
  for (const auto& body : bodies_) world.removeSoftBody(body.get());
  for (const auto& rigid : rigids_) world.removeRigidBody(rigid.get());
}

btSoftBody& DemoWorld::add(btSoftBody* body) {
  bodies_.emplace_back(body);
  world.addSoftBody(body);
  return *body;
}

btRigidBody& DemoWorld::add_rigid(std::unique_ptr<btCollisionShape> shape, double mass,
                                  const btVector3& place) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
  rigids_.push_back(std::make_unique<btRigidBody>(btScalar(mass), nullptr, shape.get(), inertia));
  btRigidBody& rigid = *rigids_.back();
  rigid.setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
  rigid.setInterpolationWorldTransform(rigid.getWorldTransform());
  rigid.setFriction(1);
  shapes_.push_back(std::move(shape));
  world.addRigidBody(&rigid);
  return rigid;
}

void DemoWorld::add_falling_boxes(int count) {
  for (int i = 0; i < count; ++i) {
    add_rigid(std::make_unique<btBoxShape>(vector(0.5, 0.5, 0.5)), 1,
              vector(0.3 * (i % 3), 2 + 6 * i, 0.2 * (i % 2)));
  }
}

void DemoWorld::add_plate(double mass, double height) {
  add_rigid(std::make_unique<btBoxShape>(vector(5, 1, 5)), mass, vector(0, height, 0));
}

void DemoWorld::add_stair(int num_steps) {
  for (int i = 0; i < num_steps; ++i) {
    add_rigid(std::make_unique<btBoxShape>(vector(1, 0.5, 5)), 0,
              vector(2 * i, kFloor + 0.5 + 0.5 * i, 0));
  }
}

const std::vector<DemoScene>& demo_scenes() {
  static const std::vector<DemoScene> kScenes = {
      {"cloth", cloth},
      {"pressure", pressure},
      {"volume", volume},
      {"ropes", ropes},
      {"rope_attach", anchored_ropes},
      {"cloth_attach", anchored_cloth},
      {"sticks", sticks},
      {"capsule_collision", on_capsule},
      {"collide_tori", [](DemoWorld& world) { meeting_bodies(world, false); }},
      {"collide_animals", [](DemoWorld& world) { meeting_bodies(world, true); }},
      {"collide_cloths", cloth_on_cloth},
      {"impact", impact},
      {"aero_flyers", flyers, false},
      {"aero_curtains", curtains, false},
      {"friction", sliding_boxes},
      {"torus", [](DemoWorld& world) { soft_torus(world, false); }},
      {"torus_match", [](DemoWorld& world) { soft_torus(world, true); }},
      {"animal", [](DemoWorld& world) { lone_animal(world, false); }},
      {"animal_match", [](DemoWorld& world) { lone_animal(world, true); }},
      {"cutting", cut_sheet},
      {"cluster_deform", clusters_deform},
      {"cluster_collide_boxes", clusters_under_boxes},
      {"cluster_collide_tori", clusters_meet},
      {"cluster_socket", [](DemoWorld& world) { clusters_jointed(world, false); }},
      {"cluster_hinge", [](DemoWorld& world) { clusters_jointed(world, true); }},
      {"cluster_combine", [](DemoWorld& world) { clusters_combined(world, 1); }},
      {"cluster_car", [](DemoWorld& world) { clusters_combined(world, 4); }},
      {"cluster_robot", clusters_carry_plate},
      {"cluster_stack_soft", [](DemoWorld& world) { clusters_stack(world, false); }},
      {"cluster_stack_mixed", [](DemoWorld& world) { clusters_stack(world, true); }},
      {"tetra_cube", [](DemoWorld& world) { tetrahedra(world, 3, 4, false); }},
      {"tetra_clusters", [](DemoWorld& world) { tetrahedra(world, 4, 5, true); }},
  };
  return kScenes;
}

}  // namespace weft::bench
