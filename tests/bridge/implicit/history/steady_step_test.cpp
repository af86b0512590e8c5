// Steps of one body that nothing else has a part in, and those that change nothing.
#include <algorithm>
#include <functional>
#include <string_view>

#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/core/trace.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

const std::vector<forces::LawSpecification> kLaws = {kGravity, law("tension", "stiffness", 300)};

/// A cloth that lies on a floor.
class LyingCloth {
 public:
  LyingCloth()
      : scene_(cloth(10, 0.5, 0.03), kLaws),
        floor_(&scene_.add(box(2, 0.5, 2), 0, at(0, -0.5, 0))) {
    scene_.step(60);
  }
  [[nodiscard]] Scene& scene() { return scene_; }
  [[nodiscard]] btRigidBody& floor() { return *floor_; }

 private:
  Scene scene_;
  btRigidBody* floor_;
};

/// Solutions in some steps.
int num_solutions(Scene& scene, int num_steps) {
  start_trace();
  scene.step(num_steps);
  int count = 0;
  for (const TraceThread& thread : stop_trace()) {
    count += static_cast<int>(
        std::count_if(thread.events.begin(), thread.events.end(),
                      [](const TraceEvent& event) { return event.name == "implicit solve"; }));
  }
  return count;
}

TEST(SteadyStep, IsNotSolvedAgain) {
  LyingCloth cloth;
  const Matrix3X<double> positions = cloth.scene().positions();
  const Matrix3X<double> velocities = cloth.scene().velocities();
  const int num_contacts = cloth.scene().solver().num_contacts(cloth.scene().body());
  EXPECT_EQ(num_contacts, 100);
  EXPECT_EQ(num_solutions(cloth.scene(), 20), 0);
  EXPECT_EQ(cloth.scene().positions(), positions);
  EXPECT_EQ(cloth.scene().velocities(), velocities);
  EXPECT_EQ(cloth.scene().solver().num_contacts(cloth.scene().body()), num_contacts);
  double weight = 0;
  for (const NodeContact& contact : cloth.scene().solver().rigid_contacts(cloth.scene().body())) {
    weight += static_cast<double>(contact.impulse.y()) / kTimeStep;
  }
  EXPECT_NEAR(weight, 0.25 * 9.81, 0.01);
}

// Each is noticed in the same step, and by what it does.
TEST(SteadyStep, EndsWithWhateverChanges) {
  const std::vector<std::function<void(LyingCloth&)>> changes = {
      [](LyingCloth& one) { one.scene().body().m_nodes[3].m_v.setY(btScalar(0.1)); },
      [](LyingCloth& one) { one.scene().body().m_nodes[3].m_x += vector(0, 0.01, 0); },
      [](LyingCloth& one) { one.scene().body().addForce(vector(0, 0.1, 0), 7); },
      [](LyingCloth& one) { one.scene().body().setMass(5, 0); },
      [](LyingCloth& one) { one.scene().body().m_nodes[5].m_im *= btScalar(0.5); },
      [](LyingCloth& one) { one.floor().setWorldTransform(at(0, -0.7, 0)); },
      [](LyingCloth& one) {
        one.floor().setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT |
                                      btCollisionObject::CF_NO_CONTACT_RESPONSE);
      },
      [](LyingCloth& one) { one.scene().body().m_worldInfo->m_gravity = vector(1, 0, 0); },
      [](LyingCloth& one) { one.scene().body().m_cfg.kDF = btScalar(0.1); },
      [](LyingCloth& one) { one.scene().body().getCollisionShape()->setMargin(btScalar(0.02)); },
      [](LyingCloth& one) { one.floor().setFriction(btScalar(0.2)); },
      [](LyingCloth& one) { one.scene().add(box(0.1, 0.1, 0.1), 1, at(0, 0.11, 0)); },
  };
  for (std::size_t k = 0; k < changes.size(); ++k) {
    LyingCloth cloth;
    ASSERT_EQ(num_solutions(cloth.scene(), 1), 0) << k;
    changes[k](cloth);
    EXPECT_GT(num_solutions(cloth.scene(), 1), 0) << k;
  }
  LyingCloth shorter;
  start_trace();
  shorter.scene().step(1, kTimeStep / 2);
  EXPECT_NE(stop_trace().size(), 0U);
}

/// A cloth with contacts of its own with other cloth, of which there is none, goes through the stages of all bodies one by one.
TEST(BodyAlone, HasTheBitsOfBodiesThatGoTogether) {
  Matrix3X<double> results[2];
  for (const bool is_alone : {false, true}) {
    Scene scene(cloth(20, 1, 0.3), kLaws);
    scene.set_velocity(btVector3(1, 0, 0));
    scene.add(std::make_shared<btSphereShape>(btScalar(0.25)), 0, at(0.1, 0, 0));
    scene.add(box(2, 0.5, 2), 0, at(0, -0.6, 0));
    if (!is_alone) scene.solver().set_cloth_contact(scene.body(), {.with_others = true});
    scene.step(60);
    EXPECT_GT(scene.solver().num_contacts(scene.body()), 20);
    results[is_alone ? 1 : 0] = scene.positions();
  }
  EXPECT_EQ(results[0], results[1]);
}

// Whatever is kept or not, no node goes another way.
TEST(FastSettings, KeepNormalsAndTreesOfBulletOrNot) {
  Matrix3X<double> results[2];
  for (const bool keeps : {false, true}) {
    Scene scene(cloth(12, 1, 0.3), kLaws, 0.5,
                {.may_sleep = false, .keeps_normals = keeps, .keeps_node_tree = keeps});
    scene.add(std::make_shared<btSphereShape>(btScalar(0.25)), 0, at(0.1, 0, 0));
    scene.step(30);
    const btVector3 normal = scene.body().m_nodes[0].m_n;
    const btSoftBody::Node& node = scene.body().m_nodes[0];
    btVector3 in_leaf = node.m_x;
    in_leaf.setMax(node.m_leaf->volume.Mins());
    in_leaf.setMin(node.m_leaf->volume.Maxs());
    EXPECT_EQ((node.m_x - in_leaf).length() < btScalar(0.05), keeps);
    scene.body().updateNormals();
    EXPECT_EQ(scene.body().m_nodes[0].m_n == normal, keeps);
    results[keeps ? 1 : 0] = scene.positions();
  }
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace
}  // namespace weft::bridge
