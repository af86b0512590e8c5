// Contacts of cloth with force laws: Signorini's and Coulomb's laws, and that Bullet's own visits do not follow them.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>

#include "tests/bridge/rigid_objects.hpp"

namespace weft::bridge {
namespace {

constexpr double kRigidResponseTimeStep = 1.0 / 1000;  // [s]
constexpr double kMargin = 0.01;                       // [m]
constexpr double kGravity = 9.81;                      // [m/s^2]

/// A flat cloth along a slope through the origin, lifted [m] over where it would touch, in Bullet's world with laws.
class Slope {
 public:
  Slope(double angle, double friction, double lift, ContactResponse response) {
    down_ = {std::cos(angle), -std::sin(angle), 0};
    normal_ = {std::sin(angle), std::cos(angle), 0};
    ClothGrid grid;
    grid.nodes = {6, 6};
    grid.size = {0.5, 0.5};
    grid.u_axis = down_;
    grid.center = normal_ * (kMargin + lift);
    grid.total_mass = 0.1;
    mesh_ = make_cloth_grid(grid);
    masses_ = mesh_.masses;
    body_ = &world_.add(
        make_cloth_body(world_.info(), mesh_, {.collision_margin = kMargin, .friction = friction}));
    world_.solver().attach(*body_, mesh_, laws());
    world_.solver().set_contact_response(*body_, response);
    btTransform place(btQuaternion(btVector3(0, 0, 1), static_cast<btScalar>(-angle)));
    place.setOrigin(place.getBasis() * btVector3(0, -1, 0));
    add_rigid(world_, std::make_shared<btBoxShape>(btVector3(10, 1, 10)), 0, place);
  }
  btRigidBody& throw_ball(double mass, const btTransform& place, const btVector3& velocity,
                          double gravity, double radius = 0.1) {
    btRigidBody& ball = add_rigid(
        world_, std::make_shared<btSphereShape>(static_cast<btScalar>(radius)), mass, place);
    ball.setGravity(vector(0, -gravity, 0));
    ball.setLinearVelocity(velocity);
    return ball;
  }
  static std::vector<forces::LawSpecification> laws() {
    return {{"gravity", {}, {{"acceleration", {0.0, -kGravity, 0.0}}}},
            {"tension", {}, {{"stiffness", {20.0}}}}};
  }
  void replace_laws() { world_.solver().replace_laws(*body_, mesh_, laws()); }
  void push(double speed) {
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      const Vector3<btScalar> v = (speed * down_).cast<btScalar>();
      body_->m_nodes[i].m_v = btVector3(v[0], v[1], v[2]);
    }
  }
  void step(int num_steps) {
    for (int i = 0; i < num_steps; ++i) world_.step(kRigidResponseTimeStep);
  }
  /// How far the middle has come [m], and how fast it is [m/s].
  [[nodiscard]] double way() const { return down_.dot(mean(0)); }
  [[nodiscard]] double speed() const { return down_.dot(mean(1)); }
  /// Largest speed of a node away from the slope [m/s].
  [[nodiscard]] double leaving_speed() const { return (normal_.transpose() * read(1)).maxCoeff(); }
  [[nodiscard]] double largest_speed() const { return read(1).colwise().norm().maxCoeff(); }
  /// Smallest distance of a node from where it touches [m].
  [[nodiscard]] double depth() const {
    return kMargin - (normal_.transpose() * read(0)).minCoeff();
  }
  [[nodiscard]] double highest() const { return (normal_.transpose() * read(0)).maxCoeff(); }
  [[nodiscard]] Vector3<double> momentum() const { return read(1) * masses_; }
  [[nodiscard]] SoftWorld& world() { return world_; }
  [[nodiscard]] btSoftBody& body() { return *body_; }

 private:
  [[nodiscard]] Matrix3X<double> read(int what) const {
    Matrix3X<btScalar> x;
    Matrix3X<btScalar> v;
    read_nodes(*body_, x, v);
    return (what == 0 ? x : v).cast<double>();
  }
  [[nodiscard]] Vector3<double> mean(int what) const {
    return read(what) * masses_ / masses_.sum();
  }

  SoftWorld world_{SoftWorldSettings{}};
  Vector3<double> down_;
  Vector3<double> normal_;
  ClothMesh mesh_;
  VectorX<double> masses_;
  btSoftBody* body_;
};

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

// Friction 0.3 holds up to 16.7 degrees. Sums over 500 steps of single precision: 3 % of the acceleration.
TEST(RigidResponse, SticksBelowTheThresholdAndSlidesAboveItAsCoulombSays) {
  for (const double angle : {5.0, 15.0, 18.5, 30.0}) {
    Slope slope(radians(angle), 0.3, 0, ContactResponse::kCoulomb);
    slope.step(500);
    const double pull = std::sin(radians(angle)) - 0.3 * std::cos(radians(angle));
    if (pull < 0) {
      EXPECT_LT(slope.largest_speed(), 1e-3) << angle;
    } else {
      EXPECT_NEAR(slope.speed(), 0.5 * kGravity * pull, 0.03 * 0.5 * kGravity * pull) << angle;
    }
  }
}

TEST(RigidResponse, StopsASlidingClothAfterItsWay) {
  const auto error = [](ContactResponse response) {
    Slope slope(0, 0.4, 0, response);
    slope.push(1);
    slope.step(500);
    EXPECT_LT(slope.largest_speed(), 1e-3);
    return std::abs(slope.way() - 1 / (2 * 0.4 * kGravity));
  };
  EXPECT_LT(error(ContactResponse::kCoulomb),
            1 * kRigidResponseTimeStep);  // v h of a sum over steps
  EXPECT_GT(error(ContactResponse::kBullet), 0.1);
}

// It falls 2 cm and arrives with 0.63 m/s, all nodes in the same step; how deep that step would lead depends on the height.
TEST(RigidResponse, LandsWithoutABounce) {
  const auto leaving_speed = [](ContactResponse response) {
    double most = 0;
    for (int k = 0; k < 10; ++k) {
      const double lift = 0.02 + k * 0.63e-4;  // a step's way is 0.63 mm
      Slope slope(0, 0.4, lift, response);
      for (int i = 0; i < 100; ++i) {
        slope.step(1);
        most = std::max(most, slope.leaving_speed());
        EXPECT_LT(slope.depth(), 1e-6);
      }
    }
    return most;
  };
  EXPECT_LT(leaving_speed(ContactResponse::kCoulomb), 1e-3);
  EXPECT_GT(leaving_speed(ContactResponse::kBullet), 0.03);  // hardness 0.1 times 0.63 m/s at most
}

TEST(RigidResponse, GivesABallTheMomentumThatTheClothLoses) {
  Slope scene(0, 0.4, 1.0, ContactResponse::kCoulomb);
  btRigidBody& ball = scene.throw_ball(0.5, at(0.03, 0.85, 0.02), vector(0.3, 2, 0), 0);
  const double ball_before = 0.5 * static_cast<double>(ball.getLinearVelocity().y());
  const double cloth_before = scene.momentum()[1];
  scene.step(60);
  const double lost = ball_before - 0.5 * static_cast<double>(ball.getLinearVelocity().y());
  const double won = scene.momentum()[1] - cloth_before + 0.1 * kGravity * 0.06;
  EXPECT_GT(lost, 0.02);  // they have met
  // Single precision: velocities are differences of places of 1 m, each off by eps x / h = 6e-5 m/s; 2e-3 of 0.1 kg times the
  // root of 60 steps of them.
  EXPECT_NEAR(won, lost, sizeof(btScalar) == sizeof(float) ? 5e-3 * lost : 1e-6 * lost);
}

// What moves nodes out of a ball that they push gives them no speed, with other cloth about or not.
TEST(RigidResponse, MakesNoMomentumWhereOtherClothMayCome) {
  Slope scene(0, 0.4, 1.0, ContactResponse::kCoulomb);
  scene.world().solver().set_cloth_contact(scene.body(), {.with_others = true, .margin = kMargin});
  btRigidBody& ball = scene.throw_ball(0.01, at(0.05, 0.885, 0.05), vector(0, 2, 0), 0);
  const double before = scene.momentum()[1] + 0.01 * 2;
  scene.step(20);
  const double after =
      scene.momentum()[1] + 0.01 * static_cast<double>(ball.getLinearVelocity().y());
  EXPECT_LT(ball.getLinearVelocity().y(), 1.9);  // they have met
  EXPECT_NEAR(after + 0.1 * kGravity * 0.02, before, 0.01 * before);
}

// A ball at 20 m/s, 2 cm a step, is stopped at once by a pillar beside the cloth.
TEST(RigidResponse, IsNotPushedByABallThatSomethingElseStops) {
  Slope scene(0, 0.4, 1.0, ContactResponse::kCoulomb);
  btRigidBody& ball = scene.throw_ball(1, at(0.4, 1.29, 0.05), vector(0, -20, 0), 0, 0.3);
  add_rigid(scene.world(), std::make_shared<btBoxShape>(vector(0.1, 0.1, 0.1)), 0,
            at(0.45, 0.89, 0.05));
  const double before = scene.depth();
  scene.step(1);
  EXPECT_GT(ball.getCenterOfMassPosition().y(), 1.28);
  EXPECT_NEAR(scene.depth(), before, 0.001);
}

// A twentieth of 0.1 kg of cloth meets 10 g: the pair goes on together, and a push that is counted twice would part it.
TEST(RigidResponse, DoesNotBounceOffALightBall) {
  Slope scene(0, 0.4, 1.0, ContactResponse::kCoulomb);
  btRigidBody& ball = scene.throw_ball(0.01, at(0.05, 0.885, 0.05), vector(0, 2, 0), kGravity);
  double lowest = 2;
  for (int i = 0; i < 40; ++i) {
    scene.step(1);
    // The nodes that were hit first go on at the common speed; the ball is not thrown back.
    lowest = std::min(lowest, static_cast<double>(ball.getLinearVelocity().y()));
  }
  EXPECT_LT(lowest, 1.9);  // they have met
  EXPECT_GT(lowest, -kGravity * 0.04);
}

// A second cloth, five times as heavy, falls on one that lies on the ground.
TEST(RigidResponse, KeepsALayerOutOfTheGroundUnderAnother) {
  Slope scene(0, 0.4, 0, ContactResponse::kCoulomb);
  ClothGrid grid;
  grid.nodes = {6, 6};
  grid.size = {0.4, 0.4};
  grid.center = {0, 0.06, 0};
  grid.total_mass = 0.5;
  const ClothMesh mesh = make_cloth_grid(grid);
  SoftBodySolver& solver = scene.world().solver();
  btSoftBody& upper = scene.world().add(
      make_cloth_body(scene.world().info(), mesh, {.collision_margin = kMargin, .friction = 0.4}));
  solver.attach(upper, mesh, Slope::laws());
  for (btSoftBody* body : {&scene.body(), &upper}) {
    solver.set_cloth_contact(*body, {.with_others = true, .margin = kMargin});
  }
  for (int i = 0; i < 400; ++i) {
    scene.step(1);
    // As it lands, the upper one pushes after the lower one was solved.
    ASSERT_LT(scene.depth(), (i < 200 ? 0.3 : 0.05) * kMargin) << i;
  }
  double lowest = 1;
  for (int i = 0; i < upper.m_nodes.size(); ++i) {
    lowest = std::min(lowest, static_cast<double>(upper.m_nodes[i].m_x.y()));
  }
  EXPECT_GT(lowest, 1.5 * kMargin);  // on the lower one, not in it
}

TEST(RigidResponse, OutlivesOtherLaws) {
  const auto way = [](bool is_replaced) {
    Slope slope(0, 0.4, 0, ContactResponse::kBullet);
    if (is_replaced) slope.replace_laws();
    slope.push(1);
    slope.step(500);
    return slope.way();
  };
  EXPECT_EQ(way(true), way(false));
}

// 2 cm inside at first: put outside at once, and at rest.
TEST(RigidResponse, ADepthThatWasThereGivesNoSpeed) {
  Slope slope(0, 0.4, -0.02, ContactResponse::kCoulomb);
  slope.step(1);
  EXPECT_LT(slope.depth(), 1e-6);
  EXPECT_LT(slope.largest_speed(), 1e-3);
}

// Above a box, at the distance at which it lies there, and off its edge with 2 cm a step: nothing lifts it.
TEST(RigidResponse, ClothThatLeavesAnEdgeIsNotLifted) {
  Slope scene(0, 0.4, 1.0, ContactResponse::kCoulomb);
  add_rigid(scene.world(), std::make_shared<btBoxShape>(vector(1, 0.25, 1)), 0, at(-0.9, 0.75, 0));
  scene.push(20);
  double most = 0;
  for (int i = 0; i < 20; ++i) {
    scene.step(1);
    most = std::max(most, scene.highest() - 1.0 - kMargin);
  }
  EXPECT_LT(most, 1e-5);
}

// Friction between them would turn the box, were it left with what the first visit gives it.
TEST(RigidResponse, ABoxRestsOnPinnedNodes) {
  Slope scene(0, 0.4, 1.0, ContactResponse::kCoulomb);
  for (int i = 0; i < scene.body().m_nodes.size(); ++i) {
    scene.body().setMass(i, 0);
    scene.body().m_nodes[i].m_v.setZero();
  }
  btRigidBody& box = add_rigid(scene.world(), std::make_shared<btBoxShape>(vector(0.2, 0.1, 0.2)),
                               2, at(0.02, 1.101 + 2 * kMargin, 0.01));
  box.setGravity(vector(0, -kGravity, 0));
  scene.step(500);
  EXPECT_LT(box.getAngularVelocity().length(), 1e-3);
  EXPECT_NEAR(box.getCenterOfMassPosition().y(), 1.1 + 2 * kMargin, 0.001);
}

TEST(RigidResponse, IsOfBodiesWithLawsOnly) {
  Slope slope(0, 0.4, 0, ContactResponse::kCoulomb);
  slope.world().solver().detach(slope.body());
  EXPECT_THROW(slope.world().solver().set_contact_response(slope.body(), ContactResponse::kBullet),
               InvalidArgument);
}

}  // namespace
}  // namespace weft::bridge
