#include <weft/bridge/snapshot.hpp>

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/tearing.hpp>
#include <weft/core/error.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

constexpr int kNodes = 20;  // along an edge

const std::vector<forces::LawSpecification> kLaws{kGravity, law("tension", "stiffness", 500.0),
                                                  law("velocity_damping", "rate", 1.0)};

ClothMesh pinned_cloth() {
  ClothMesh mesh = cloth(kNodes, 1.0, 1.0);
  mesh.pinned = {0, kNodes - 1};
  return mesh;
}

/// A cloth that hangs on two corners, on which a ball falls.
class BallScene : public Scene {
 public:
  explicit BallScene(const FastSettings& settings = {.may_sleep = false})
      : Scene(pinned_cloth(), kLaws, 0.5, settings) {
    btTransform place = btTransform::getIdentity();
    place.setOrigin(btVector3(btScalar(0.1), btScalar(1.4), 0));
    ball_ = &add(std::make_shared<btSphereShape>(btScalar(0.15)), 0.3, place);
  }
  [[nodiscard]] btRigidBody& ball() { return *ball_; }
  void save(Snapshot& snapshot) { snapshot.save(world().world(), solver()); }
  void restore(const Snapshot& snapshot) { snapshot.restore(world().world(), solver()); }

  /// Positions and velocities of everything, after each of some steps.
  std::vector<double> run(int num_steps) {
    std::vector<double> numbers;
    for (int i = 0; i < num_steps; ++i) {
      step();
      const Matrix3X<double> x = positions();
      const Matrix3X<double> v = velocities();
      numbers.insert(numbers.end(), x.data(), x.data() + x.size());
      numbers.insert(numbers.end(), v.data(), v.data() + v.size());
      for (int k = 0; k < 3; ++k) {
        numbers.push_back(static_cast<double>(ball_->getWorldTransform().getOrigin()[k]));
        numbers.push_back(static_cast<double>(ball_->getAngularVelocity()[k]));
      }
    }
    return numbers;
  }

 private:
  btRigidBody* ball_;
};

template <class Work>
std::string refusal_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Snapshot, GoesBackBeforeDuringAndAfterAnImpact) {
  BallScene scene;
  Snapshot snapshot;
  for (int k = 0; k < 8; ++k) {
    scene.save(snapshot);
    const std::vector<double> first = scene.run(8);
    scene.restore(snapshot);
    EXPECT_EQ(scene.run(8), first) << "at step " << 8 * k;
  }
}

TEST(Snapshot, GoesOnInAnotherWorld) {
  BallScene scene;
  (void)scene.run(25);
  Snapshot snapshot;
  scene.save(snapshot);
  const std::vector<double> first = scene.run(20);
  BallScene other;
  other.restore(Snapshot(snapshot.bytes()));
  EXPECT_EQ(other.run(20), first);
}

// The state of the world is compared with that of a run that only went forwards between the same snapshots.
TEST(Snapshot, SurvivesRandomSequences) {
  std::mt19937 random(7);
  const auto up_to = [&](int most) {
    return static_cast<int>(random() % static_cast<std::uint32_t>(most)) + 1;
  };
  BallScene scene;
  for (int round = 0; round < 12; ++round) {
    Snapshot snapshot;
    scene.save(snapshot);
    const int num_steps = up_to(10);
    const std::vector<double> first = scene.run(num_steps);
    for (int k = 0; k < 3; ++k) {
      scene.restore(snapshot);
      (void)scene.run(up_to(15));
      Snapshot other;
      scene.save(other);
      (void)scene.run(up_to(3));
      scene.restore(other);
    }
    scene.restore(snapshot);
    ASSERT_EQ(scene.run(num_steps), first) << "round " << round;
  }
}

TEST(Snapshot, GoesBackOverPinsThatChange) {
  BallScene scene;
  (void)scene.run(10);
  Snapshot pinned;
  scene.save(pinned);
  const std::vector<double> first = scene.run(10);
  const btScalar inverse_mass = scene.body().m_nodes[1].m_im;
  scene.body().m_nodes[0].m_im = inverse_mass;
  Snapshot free;
  (void)scene.run(3);
  scene.save(free);
  const std::vector<double> later = scene.run(10);
  scene.restore(pinned);
  EXPECT_EQ(scene.body().m_nodes[0].m_im, 0);
  EXPECT_EQ(scene.run(10), first);
  scene.restore(free);
  EXPECT_EQ(scene.run(10), later);
}

TEST(Snapshot, GoesBackFromSleepAndIntoIt) {
  BallScene scene({.may_sleep = true, .sleep_speed = 10, .sleep_time = 0.2});
  scene.ball().setActivationState(DISABLE_SIMULATION);
  Snapshot awake;
  scene.step(2);
  scene.save(awake);
  const std::vector<double> first = scene.run(5);
  scene.step(40);
  ASSERT_TRUE(scene.solver().is_asleep(scene.body()));
  Snapshot asleep;
  scene.save(asleep);
  scene.restore(awake);
  EXPECT_FALSE(scene.solver().is_asleep(scene.body()));
  EXPECT_EQ(scene.run(5), first);
  scene.restore(asleep);
  scene.step(3);
  EXPECT_TRUE(scene.solver().is_asleep(scene.body()));
}

TEST(Snapshot, HasForcesThatWaitForTheNextStep) {
  BallScene scene;
  (void)scene.run(3);
  scene.ball().applyCentralForce(btVector3(3, 0, 1));
  scene.body().addForce(btVector3(0, btScalar(0.1), 0), 5);
  Snapshot snapshot;
  scene.save(snapshot);
  const std::vector<double> first = scene.run(5);
  scene.restore(snapshot);
  EXPECT_EQ(scene.run(5), first);
}

TEST(Snapshot, ABodyWithLawsAndOneOfBulletGoBack) {
  SoftWorld world{SoftWorldSettings{}};
  const ClothMesh mesh = pinned_cloth();
  btSoftBody& with_laws = world.add(make_cloth_body(world.info(), mesh, {}));
  world.solver().attach(with_laws, mesh, {kGravity, law("tension", "stiffness", 5.0)});
  LinkSet links;
  links.edge_sets = {"stretch"};
  links.stiffness = 50;
  btSoftBody& plain = world.add(make_cloth_body(world.info(), cloth(kNodes, 1.0, 2.0),
                                                {.links = {links}, .time_step = kTimeStep}));
  plain.m_cfg.kDP = btScalar(0.01);
  const auto run = [&] {
    std::vector<btVector3> positions;
    for (int step = 0; step < 10; ++step) {
      world.step(1.0 / 600);
      for (const btSoftBody* body : {&with_laws, &plain}) {
        for (int i = 0; i < body->m_nodes.size(); ++i) positions.push_back(body->m_nodes[i].m_x);
      }
    }
    return positions;
  };
  (void)run();
  Snapshot snapshot;
  snapshot.save(world.world(), world.solver());
  const std::vector<btVector3> first = run();
  snapshot.restore(world.world(), world.solver());
  EXPECT_EQ(run(), first);
}

// What a game with 2,500 nodes keeps for each frame, in single precision: positions and velocities are 24 of it.
TEST(Snapshot, TakesThirtyBytesANodeBesidePositionsAndVelocities) {
  ClothMesh mesh = cloth(50, 1.0, 1.0);
  mesh.pinned = {0, 49};
  Scene scene(mesh, kLaws);
  scene.step(10);
  Snapshot snapshot;
  snapshot.save(scene.world().world(), scene.solver());
  const double beside = static_cast<double>(snapshot.size()) / 2500 - 6 * sizeof(btScalar);
  EXPECT_LT(beside, 7.5 * sizeof(btScalar));
}

TEST(Snapshot, RefusesAnotherWorld) {
  BallScene scene;
  Snapshot snapshot;
  scene.save(snapshot);
  Scene other(cloth(kNodes, 1.0, 1.0), kLaws);
  EXPECT_NE(refusal_of([&] {
              snapshot.restore(other.world().world(), other.solver());
            }).find("number of objects = 2, expected 1"),
            std::string::npos);
}

TEST(Snapshot, RefusesOtherLaws) {
  BallScene scene;
  Snapshot snapshot;
  scene.save(snapshot);
  scene.solver().replace_laws(scene.body(), pinned_cloth(),
                              {kGravity, law("tension", "stiffness", 400.0)});
  EXPECT_NE(refusal_of([&] { scene.restore(snapshot); }).find("the body had other laws"),
            std::string::npos);
}

TEST(Snapshot, RefusesATornBodyUntilItHasItsLawsAnew) {
  BallScene scene;
  (void)scene.run(3);
  Snapshot whole;
  scene.save(whole);
  ClothMesh mesh = pinned_cloth();
  const Blade blade{.from = {-0.6, 1.0, 0.01}, .to = {0.0, 1.0, 0.01}, .depth = {0, 0.5, 0}};
  (void)cut(scene.solver(), scene.body(), mesh, {.collision_margin = kMargin, .friction = 0.5},
            kLaws, blade);
  ASSERT_GT(scene.body().m_nodes.size(), kNodes * kNodes);
  EXPECT_NE(refusal_of([&] { scene.restore(whole); }).find("number of nodes = 400, expected"),
            std::string::npos);
  Snapshot torn;
  EXPECT_NE(refusal_of([&] { scene.save(torn); }).find("expected replace_laws() with its mesh"),
            std::string::npos);
  scene.solver().replace_laws(scene.body(), mesh, kLaws);
  scene.save(torn);
  const std::vector<double> first = scene.run(10);
  scene.restore(torn);
  EXPECT_EQ(scene.run(10), first);
}

TEST(Snapshot, RefusesDamage) {
  BallScene scene;
  (void)scene.run(3);
  Snapshot snapshot;
  scene.save(snapshot);
  std::vector<std::byte> bytes = snapshot.bytes();
  bytes.resize(bytes.size() / 2);
  EXPECT_NE(refusal_of([&] { scene.restore(Snapshot(bytes)); }), "");
  scene.restore(snapshot);  // and is of use again
  EXPECT_EQ(scene.run(1).size(), scene.run(1).size());
}

}  // namespace
}  // namespace weft::bridge
