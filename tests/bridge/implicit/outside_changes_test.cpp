// What a program does to a fast body from outside: pushes, anchors, another size; and what it is told of contacts.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <weft/bridge/classic/nodes/pinned_nodes.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

/// In the air, without gravity, after some steps: of second order by then.
class Floating : public Scene {
 public:
  Floating() : Scene(cloth(11, 1, 0), {law("tension", "stiffness", 1000)}) { step(6); }
};

TEST(OutsideChanges, AVelocityThatIsGivenCountsOnce) {
  using Give = void (*)(btSoftBody&);
  const Give gives[] = {
      [](btSoftBody& body) { body.addVelocity(btVector3(0, 5, 0), 60); },
      [](btSoftBody& body) { body.m_nodes[60].m_v += btVector3(0, 5, 0); },
  };
  for (const Give give : gives) {
    Floating scene;
    const double before = scene.momentum().y();
    give(scene.body());
    const double given = 5 / static_cast<double>(scene.body().m_nodes[60].m_im);  // [N s]
    for (const int num_steps : {1, 1, 30}) {
      scene.step(num_steps);
      EXPECT_NEAR(scene.momentum().y() - before, given, 1e-3 * given);
    }
  }
}

TEST(OutsideChanges, ABodyThatIsStoppedStands) {
  Floating scene;
  scene.body().addVelocity(btVector3(3, 0, 0));
  scene.step(3);
  EXPECT_NEAR(scene.mean_velocity().x(), 3, 1e-3);
  scene.body().setVelocity(btVector3(0, 0, 0));
  for (int step = 0; step < 6; ++step) {
    scene.step();
    EXPECT_NEAR(scene.mean_velocity().x(), 0, 1e-3) << step;
  }
}

TEST(OutsideChanges, AForceOfOneStepGivesItsImpulse) {
  Floating scene;
  const double before = scene.momentum().y();
  scene.body().addForce(btVector3(0, 2, 0), 60);
  for (const int num_steps : {1, 1, 30}) {
    scene.step(num_steps);
    EXPECT_NEAR(scene.momentum().y() - before, 2 * kTimeStep, 2e-3 * kTimeStep);
  }
}

TEST(OutsideChanges, WhatIsThrownUpRisesAsHighAsItsSpeedSays) {
  Scene scene(cloth(11, 1, 0), {kGravity, law("tension", "stiffness", 1000)});
  scene.step(6);
  scene.body().setVelocity(btVector3(0, 5, 0));
  const double start = scene.positions().row(1).mean();
  double highest = start;
  for (int step = 0; step < 60; ++step) {
    scene.step();
    highest = std::max(highest, scene.positions().row(1).mean());
  }
  // v^2 / (2 g); the step in which it is thrown is of first order, v h / 2 at most.
  EXPECT_NEAR(highest - start, 25 / (2 * 9.81), 5 * kTimeStep / 2);
}

// A weight at rest on a rope in the air that a push tightens: one step, before any of them has moved far.
TEST(OutsideChanges, AnAnchorsInfluenceIsThePartOfItsPullThatTheObjectGets) {
  double speeds[2] = {};
  for (const int half : {0, 1}) {
    SoftWorld world({.gravity = Vector3<double>::Zero()});
    const ClothMesh mesh = cloth(5, 0.5, 0);
    btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
    ASSERT_FALSE(world.solver().attach_fast(body, mesh, {law("tension", "stiffness", 500)}, {}));
    btRigidBody& load = add_rigid(world, box(0.1, 0.1, 0.1), 2.0, at(1.5, 0, 0));
    body.appendAnchor(0, &load, true, half == 1 ? btScalar(0.5) : btScalar(1));
    for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_v = btVector3(-1, 0, 0);
    world.step(kTimeStep);
    speeds[half] = static_cast<double>(load.getLinearVelocity().x());
  }
  EXPECT_LT(speeds[0], -1e-3);
  EXPECT_NEAR(speeds[1] / speeds[0], 0.5, 0.01);
}

// Laws know the rest shape of their mesh. Bullet's scale() makes the present shape that of the links.
TEST(OutsideChanges, ABodyHasAnotherSizeAtRestWithOtherLaws) {
  const std::vector<forces::LawSpecification> laws{law("tension", "stiffness", 500),
                                                   law("velocity_damping", "rate", 5)};
  const auto width = [](const Scene& scene) {
    const Matrix3X<double> x = scene.positions();
    return x.row(0).maxCoeff() - x.row(0).minCoeff();
  };
  ClothMesh mesh = cloth(7, 1, 0);
  Scene scene(mesh, laws);
  scene.step(5);
  scene.body().scale(btVector3(2, 2, 2));
  mesh.rest_positions *= 2;
  scene.solver().replace_laws(scene.body(), mesh, laws);
  scene.step(120);
  EXPECT_NEAR(width(scene), 2, 1e-3);

  Scene other(cloth(7, 1, 0), laws);
  other.step(5);
  // From twice its size it would be drawn through itself, and rest so.
  other.body().scale(btVector3(btScalar(1.3), btScalar(1.3), btScalar(1.3)));
  other.step(240);
  EXPECT_NEAR(width(other), 1, 1e-2);
}

// As an engine does that moves pins, and waits for them to go on. A step that lost its history would damp the swing.
TEST(OutsideChanges, PinsThatAreLedToWhereTheyAreChangeNoBit) {
  ClothMesh mesh = cloth(11, 1, 0);
  mesh.pinned = {0, 10};
  const std::vector<forces::LawSpecification> laws{kGravity, law("tension", "stiffness", 500)};
  Scene plain(mesh, laws);
  Scene led(mesh, laws);
  const Matrix3X<double> targets = led.positions()(Eigen::all, mesh.pinned);
  for (int step = 0; step < 60; ++step) {
    plain.step();
    move_kinematic_nodes(mesh.pinned, targets, kTimeStep, led.body());
    led.solver().set_position_limits(led.body(), {});
    led.solver().wake(led.body());
    led.step();
    place_nodes(mesh.pinned, targets, kTimeStep, led.body());
    ASSERT_EQ(plain.positions(), led.positions()) << step;
  }
}

// A slider that changes a stiffness must not stop the picture. 1.5 steps are usual; what looked at each node apart took 40.
TEST(OutsideChanges, OtherLawsTakeNoLongerThanAFewSteps) {
  using Clock = std::chrono::steady_clock;
  const std::vector<forces::LawSpecification> laws{kGravity, law("tension", "stiffness", 2000),
                                                   law("hinge_torsion", "rigidity", 1e-4)};
  ClothMesh mesh = cloth(31, 1, 0);
  mesh.pinned = {0, 30};
  Scene scene(mesh, laws);
  scene.step(5);
  Clock::duration replacing = Clock::duration::max();
  Clock::duration stepping = Clock::duration::max();
  for (int i = 0; i < 10; ++i) {
    const Clock::time_point start = Clock::now();
    scene.solver().replace_laws(scene.body(), mesh, laws);
    replacing = std::min(replacing, Clock::now() - start);
    scene.step();  // factorises
    const Clock::time_point ordinary = Clock::now();
    scene.step();
    stepping = std::min(stepping, Clock::now() - ordinary);
  }
  EXPECT_LT(replacing, 6 * stepping);
}

/// Cloth that lies on a box, fast or not.
void expect_contacts_on_a_box(bool is_fast) {
  SoftWorld world({});
  ClothMesh mesh = cloth(5, 0.4, 0.02);
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {.collision_margin = kMargin}));
  const std::vector<forces::LawSpecification> laws{kGravity, law("tension", "stiffness", 5),
                                                   law("velocity_damping", "rate", 5)};
  if (is_fast) {
    ASSERT_FALSE(world.solver().attach_fast(body, mesh, laws));
  } else {
    world.solver().attach(body, mesh, laws);
  }
  // Under a part of the cloth only, which is pinned in the air beside it.
  const btRigidBody& ground = add_rigid(world, box(0.12, 0.5, 0.5), 0, at(-0.1, -0.5, 0));
  EXPECT_TRUE(world.solver().rigid_contacts(body).empty());
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    if (body.m_nodes[i].m_x.x() > 0.05) body.m_nodes[i].m_im = 0;
  }
  const double step = is_fast ? kTimeStep : kTimeStep / 8;
  for (double t = 0; t < 2; t += step) world.step(step);
  const std::vector<NodeContact> contacts = world.solver().rigid_contacts(body);
  EXPECT_EQ(static_cast<int>(contacts.size()), world.solver().num_contacts(body));
  std::vector<int> touched;
  for (const NodeContact& contact : contacts) {
    ASSERT_GE(contact.node, 0);
    ASSERT_LT(contact.node, body.m_nodes.size());
    EXPECT_EQ(contact.object, &ground);
    if (std::abs(static_cast<double>(contact.distance)) > 1e-3) continue;
    touched.push_back(contact.node);
    EXPECT_NEAR(static_cast<double>(contact.normal.length()), 1, 1e-4);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  std::vector<int> expected;  // whoever lies on the box
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btVector3& place = body.m_nodes[i].m_x;
    if (body.m_nodes[i].m_im > 0 && place.y() < kMargin + 1e-3) expected.push_back(i);
  }
  EXPECT_GE(expected.size(), 10U);
  EXPECT_EQ(touched, expected);
}

TEST(OutsideChanges, ContactsOfAFastBodyAreListed) {
  expect_contacts_on_a_box(true);
}

TEST(OutsideChanges, ContactsOfABodyWithExplicitLawsAreListed) {
  expect_contacts_on_a_box(false);
}

}  // namespace
}  // namespace weft::bridge
