// Anchors to bodies that yield.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

TEST(FastBody, AnchorsStayAtABoxThatHangsAtRest) {
  ClothMesh mesh = cloth(9, 1, 2);
  mesh.pinned = {0, 8};
  Scene scene(mesh,
              {kGravity, law("tension", "stiffness", 2000), law("velocity_damping", "rate", 3)});
  // Far from the box's centre: a force there turns a box much more easily than it moves one.
  btRigidBody& load = scene.add(box(0.1, 0.1, 0.1), 2.0, at(0, 1, 0.5));
  load.setDamping(btScalar(0.5), btScalar(0.9));
  scene.body().appendAnchor(72, &load, true, 1);
  scene.body().appendAnchor(80, &load, true, 1);
  scene.step(600);
  // Bullet adds the next step of gravity before it moves the box.
  EXPECT_LT(load.getLinearVelocity().length(), 0.01 + 9.81 * kTimeStep);
  for (int a = 0; a < 2; ++a) {
    const btSoftBody::Anchor& anchor = scene.body().m_anchors[a];
    const btVector3 place = load.getWorldTransform() * anchor.m_local;
    // Its weight moves the box by g h^2 = 2.7 mm a step before the cloth holds it back, to single precision at 1 m.
    EXPECT_LT((anchor.m_node->m_x - place).length(), 2e-6) << a;
  }
}

// A sheet of 0.2 kg and a box of 0.2 kg that hangs on a corner of it fall and spin.
TEST(FastBody, ABoxOnAnAnchorKeepsTheMomentumOfBoth) {
  for (const bool is_second_order : {true, false}) {
    Scene scene(cloth(9, 1, 2, 0.2), {kGravity, law("tension", "stiffness", 500)}, 0.5,
                {.is_second_order = is_second_order});
    btRigidBody& load = scene.add(box(0.1, 0.1, 0.1), 0.2, at(0, 2.15, 0));
    load.setLinearVelocity(btVector3(1, 0, 0));
    scene.body().appendAnchor(40, &load, true, 1);
    for (int step = 1; step <= 60; ++step) {
      scene.step();
      const Vector3<double> of_box =
          0.2 * Vector3<double>(load.getLinearVelocity().x(), load.getLinearVelocity().y(),
                                load.getLinearVelocity().z());
      const Vector3<double> momentum = scene.momentum() + of_box;
      EXPECT_NEAR(momentum.x(), 0.2, 2e-4) << step;
      EXPECT_NEAR(momentum.y(), -9.81 * 0.4 * kTimeStep * step, 1e-3) << step;
    }
  }
}

/// The mean kinetic energy [J] from 1.5 to 2 s of a box of 1 kg that swings on the free edge of a sheet.
double swinging_energy(double time_step) {
  ClothMesh mesh = cloth(9, 1, 2, 0.1);
  for (int node = 72; node < 81; ++node) mesh.pinned.push_back(node);
  Scene scene(mesh, {kGravity, law("tension", "stiffness", 2000)});
  btRigidBody& load = scene.add(box(0.3, 0.05, 0.05), 1.0, at(0, 2, 0.56));
  load.setDamping(0, 0);
  for (int node = 0; node < 9; ++node) scene.body().appendAnchor(node, &load, true, 1);
  const int num_steps = static_cast<int>(std::lround(0.5 / time_step));
  scene.step(3 * num_steps, time_step);
  double sum = 0;
  for (int step = 0; step < num_steps; ++step) {
    scene.step(1, time_step);
    sum += 0.5 * static_cast<double>(load.getLinearVelocity().length2());
  }
  return sum / num_steps;
}

// Implicit Euler takes a third of it.
TEST(FastBody, ABoxOnAnchorsSwingsAsInShortSteps) {
  const double right = swinging_energy(1.0 / 1000);
  EXPECT_GT(right, 5);
  EXPECT_NEAR(swinging_energy(1.0 / 60) / right, 1, 0.05);
  EXPECT_NEAR(swinging_energy(1.0 / 120) / right, 1, 0.05);
}

// 0.6 N of 1.2 N that friction can bear; Bullet takes away in each step what the step before has given.
TEST(FastBody, PullsNoBoxThatFrictionHolds) {
  Scene scene(cloth(6, 0.4, 0.1, 0.3),
              {{"gravity", {}, {{"acceleration", {2, 0, 0}}}}, law("tension", "stiffness", 500)});
  scene.add(box(2, 0.5, 2), 0, at(0, -0.5, 0));
  btRigidBody& load = scene.add(box(0.1, 0.1, 0.1), 0.5, at(-0.3, 0.1, 0));
  int num_anchors = 0;
  for (int i = 0; i < scene.body().m_nodes.size(); ++i) {
    if (scene.body().m_nodes[i].m_x.x() > -0.19) continue;
    scene.body().appendAnchor(i, &load, true, 1);
    ++num_anchors;
  }
  EXPECT_EQ(num_anchors, 6);
  scene.step(120);
  EXPECT_NEAR(static_cast<double>(load.getCenterOfMassPosition().x()), -0.3, 1e-3);
  EXPECT_NEAR(static_cast<double>(load.getCenterOfMassPosition().y()), 0.1, 1e-3);
}

TEST(FastBody, TurnsNoBoxThatIsLocked) {
  ClothMesh mesh = cloth(9, 1, 2);
  mesh.pinned = {0, 8};
  Scene scene(mesh, {kGravity, law("tension", "stiffness", 2000)});
  btRigidBody& load = scene.add(box(0.1, 0.1, 0.1), 2.0, at(0, 1, 0.5));
  load.setAngularFactor(btScalar(0));
  scene.body().appendAnchor(72, &load, true, 1);
  scene.step(120);
  EXPECT_EQ(load.getOrientation().w(), 1);
  EXPECT_EQ(load.getAngularVelocity().length(), 0);
}

/// The highest speed of a box on strips of cloth, each held at its upper end and anchored to the box with its lower one.
double highest_speed_on_strips(int num_strips) {
  SoftWorld world(SoftWorldSettings{});
  btRigidBody& load = add_rigid(world, box(0.2, 0.2, 0.2), 0.5, at(0, 0, 0));
  for (int k = 0; k < num_strips; ++k) {
    ClothMesh mesh = cloth(6, 0.5, 0, 0.1);
    const double turn = 2 * std::numbers::pi * k / num_strips;
    const Matrix3<double> about =
        Eigen::AngleAxisd(turn, Vector3<double>::UnitY()).toRotationMatrix() *
        Eigen::AngleAxisd(std::numbers::pi / 2, Vector3<double>::UnitX()).toRotationMatrix();
    mesh.rest_positions = about * mesh.rest_positions;
    mesh.rest_positions.colwise() +=
        about * Vector3<double>(0, 0.2, 0) + Vector3<double>(0, 0.35, 0);
    for (int i = 0; i < mesh.num_nodes(); ++i) {
      if (mesh.rest_positions(1, i) > 0.59) mesh.pinned.push_back(i);
    }
    btSoftBody& body =
        world.add(make_cloth_body(world.info(), mesh, {.collision_margin = kMargin}));
    EXPECT_FALSE(world.solver().attach_fast(
        body, mesh, {kGravity, law("tension", "stiffness", 2000)}, {.may_sleep = false}));
    for (int i = 0; i < mesh.num_nodes(); ++i) {
      if (mesh.rest_positions(1, i) < 0.11) body.appendAnchor(i, &load, true, 1);
    }
    EXPECT_EQ(body.m_anchors.size(), 6);
  }
  double highest = 0;
  for (int step = 0; step < 240; ++step) {
    world.step(kTimeStep);
    if (step > 180) {
      highest = std::max(highest, static_cast<double>(load.getLinearVelocity().length()));
    }
  }
  return highest;
}

TEST(FastBody, SeveralClothsHoldOneBox) {
  // Each alone would stop the box; together they may do no more.
  for (const int num_strips : {1, 2, 3, 6}) {
    EXPECT_LT(highest_speed_on_strips(num_strips), 2) << num_strips;  // it swings
  }
}

}  // namespace
}  // namespace weft::bridge
