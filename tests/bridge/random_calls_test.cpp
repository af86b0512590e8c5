// Calls of Bullet and of Weft in random order, as a program with faults may make them: no crash, no error of memory (with the preset
// asan), and after each step numbers that are finite and pointers that belong together. VF_SS and rayTest() are left out: the tree that
// Bullet 3.24 builds for them (initializeFaceTree) does not come to an end for a body that was cut into pieces.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <weft/bridge/adoption/adopting_solver.hpp>
#include <weft/bridge/cloth.hpp>
#include <weft/core/error.hpp>
#include <weft/custom_forces/typed_laws.hpp>

#include "tests/bridge/rigid_objects.hpp"
#include "tests/support/count.hpp"

namespace weft::bridge {
namespace {

constexpr std::size_t kMostBodies = 4;
constexpr std::size_t kMostRigid = 4;
/// Beyond this a body is taken out: it has fallen, or flies on with what calls have given it [m].
constexpr btScalar kFar = 100;
constexpr int kMostNodes = 300;

/// A world of one of two kinds, and one random call after the other.
template <class World, class Constraints>
class Player {
 public:
  explicit Player(unsigned seed)
      : random_(seed),
        world_(&dispatcher_, &broadphase_, &constraints_, &configuration_, &solver_) {
    world_.getWorldInfo().m_gravity = vector(0, -10, 0);
    world_.setGravity(vector(0, -10, 0));
    world_.getWorldInfo().m_sparsesdf.Initialize();
    add_rigid(std::make_unique<btBoxShape>(vector(10, 1, 10)), 0, vector(0, -1, 0));
    solver_.set_on_blow_up([this](btSoftBody&, const BodyBlowUp&) { ++num_blow_ups_; });
  }
  ~Player() {
    while (!bodies_.empty()) remove(0);
    for (const auto& rigid : rigids_) world_.removeRigidBody(rigid.get());
  }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  void call() {
    static const std::vector<void (Player::*)()> kCalls = {
        &Player::step,          &Player::step,          &Player::step,
        &Player::add_body,      &Player::remove_body,   &Player::add_dynamic,
        &Player::remove_rigid,  &Player::change_mass,   &Player::change_pin,
        &Player::change_motion, &Player::change_pose,   &Player::change_config,
        &Player::change_links,  &Player::change_anchor, &Player::leave,
        &Player::set_law,       &Player::ask,           &Player::change_kind,
        &Player::detach,        &Player::change_world};
    (this->*kCalls[static_cast<std::size_t>(below(static_cast<int>(kCalls.size())))])();
  }
  [[nodiscard]] int num_steps() const { return num_steps_; }
  [[nodiscard]] int num_adopted_steps() const { return num_adopted_steps_; }

 private:
  struct Body {
    std::unique_ptr<btSoftBody> soft;
    Cloth cloth;
    bool is_in_world = true;
  };

  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }
  btVector3 anywhere(double size) {
    return vector(between(-size, size), between(-size, size), between(-size, size));
  }
  Body* any() {
    return bodies_.empty()
               ? nullptr
               : &bodies_[static_cast<std::size_t>(below(static_cast<int>(bodies_.size())))];
  }
  btSoftBody::Node& any_node(btSoftBody& body) { return body.m_nodes[below(body.m_nodes.size())]; }

  btRigidBody& add_rigid(std::unique_ptr<btCollisionShape> shape, double mass,
                         const btVector3& at) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
    rigids_.push_back(std::make_unique<btRigidBody>(btScalar(mass), nullptr, shape.get(), inertia));
    rigids_.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    shapes_.push_back(std::move(shape));
    world_.addRigidBody(rigids_.back().get());
    return *rigids_.back();
  }

  void step() {
    constexpr std::array kSteps = {1.0 / 60, 1.0 / 60, 1.0 / 60, 1.0 / 30, 1.0 / 240};
    world_.stepSimulation(btScalar(kSteps[static_cast<std::size_t>(below(5))]), 0);
    ++num_steps_;
    for (std::size_t b = bodies_.size(); b-- > 0;) {
      const Body& body = bodies_[b];
      if (solver_.has_laws(*body.soft)) ++num_adopted_steps_;
      const bool has_stopped = solver_.blow_up(*body.soft).has_value();
      bool is_far = false;
      for (int i = 0; i < body.soft->m_nodes.size(); ++i) {
        const btSoftBody::Node& node = body.soft->m_nodes[i];
        // Bullet's own bodies may explode by what is done to them; Weft's end in blow_up().
        const bool is_finite =
            std::isfinite(node.m_x.length2()) && std::isfinite(node.m_v.length2());
        ASSERT_TRUE(is_finite || has_stopped || !solver_.has_laws(*body.soft)) << num_steps_;
        is_far = is_far || !(node.m_x.length() < kFar);
      }
      for (int l = 0; l < body.soft->m_links.size(); ++l) {
        for (const btSoftBody::Node* end : body.soft->m_links[l].m_n) {
          ASSERT_GE(end - &body.soft->m_nodes[0], 0);
          ASSERT_LT(end - &body.soft->m_nodes[0], body.soft->m_nodes.size());
        }
      }
      ASSERT_TRUE(body.cloth.body() == nullptr || body.cloth.body() == body.soft.get());
      if (is_far || has_stopped) remove(b);
    }
    // A soft body that Bullet steps itself and that has exploded takes rigid bodies at its anchors with it. Bullet would crash over them.
    for (std::size_t r = rigids_.size(); r-- > 1;) {
      const btRigidBody& rigid = *rigids_[r];
      if (!(rigid.getCenterOfMassPosition().length() < kFar &&
            rigid.getLinearVelocity().length() < 1e6))
        remove_rigid(r);
    }
  }
  void add_body() {
    if (bodies_.size() >= kMostBodies) return;
    btSoftBodyWorldInfo& info = world_.getWorldInfo();
    const btVector3 at = anywhere(2) + vector(0, 3, 0);
    btSoftBody* soft = nullptr;
    switch (below(4)) {
      case 0:
        soft = btSoftBodyHelpers::CreatePatch(info, at, at + vector(1, 0, 0), at + vector(0, 0, 1),
                                              at + vector(1, 0, 1), 2 + below(5), 2 + below(5),
                                              below(16), below(2) == 0);
        break;
      case 1:
        soft = btSoftBodyHelpers::CreateRope(info, at, at + anywhere(1), 1 + below(8), below(4));
        break;
      case 2:
        soft = btSoftBodyHelpers::CreateEllipsoid(info, at, vector(0.5, 0.5, 0.5), 20 + below(40));
        break;
      default: {
        const btVector3 points[] = {at, at + vector(1, 0, 0), at + vector(0, 1, 0),
                                    at + vector(0, 0, 1)};
        const btScalar masses[] = {1, 1, 1, 1};
        soft = new btSoftBody(&info, 4, points, masses);
        for (int i = 1; i < 4; ++i) soft->appendLink(i - 1, i);
        if (below(2) == 0) soft->appendFace(0, 1, 2);
      }
    }
    soft->setTotalMass(btScalar(between(0.1, 5)));
    soft->getCollisionShape()->setMargin(btScalar(between(0.01, 0.1)));
    if (below(3) == 0) soft->generateBendingConstraints(2);
    bodies_.push_back({std::unique_ptr<btSoftBody>(soft), {}, true});
    bodies_.back().cloth = solver_.cloth(*soft);
    world_.addSoftBody(soft);
  }
  void remove(std::size_t b) {
    if (bodies_[b].is_in_world) world_.removeSoftBody(bodies_[b].soft.get());
    bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(b));
  }
  void remove_body() {
    if (!bodies_.empty()) remove(static_cast<std::size_t>(below(static_cast<int>(bodies_.size()))));
  }
  void add_dynamic() {
    if (rigids_.size() >= kMostRigid) return;
    const btVector3 at = anywhere(2) + vector(0, 4, 0);
    if (below(2) == 0) {
      add_rigid(std::make_unique<btSphereShape>(btScalar(0.3)), between(0.1, 5), at);
    } else {
      add_rigid(std::make_unique<btBoxShape>(vector(0.2, 0.3, 0.4)), between(0.1, 5), at);
    }
  }
  void remove_rigid() {
    if (rigids_.size() > 1) remove_rigid(rigids_.size() - 1);
  }
  // Anchors to it must go first, as Bullet asks.
  void remove_rigid(std::size_t r) {
    const btRigidBody* const gone = rigids_[r].get();
    for (Body& body : bodies_) {
      auto& anchors = body.soft->m_anchors;
      for (int a = anchors.size(); a-- > 0;) {
        if (anchors[a].m_body != gone) continue;
        anchors[a].m_node->m_battach = 0;
        anchors.swap(a, anchors.size() - 1);
        anchors.pop_back();
      }
    }
    world_.removeRigidBody(rigids_[r].get());
    rigids_.erase(rigids_.begin() + static_cast<std::ptrdiff_t>(r));
    shapes_.erase(shapes_.begin() + static_cast<std::ptrdiff_t>(r));
  }
  void change_mass() {
    Body* const body = any();
    if (body == nullptr) return;
    if (below(2) == 0) {
      body->soft->setTotalMass(btScalar(between(0.1, 10)), below(2) == 0);
    } else {
      body->soft->setMass(below(body->soft->m_nodes.size()), btScalar(between(0.01, 1)));
    }
  }
  void change_pin() {
    if (Body* const body = any()) body->soft->setMass(below(body->soft->m_nodes.size()), 0);
  }
  void change_motion() {
    Body* const body = any();
    if (body == nullptr) return;
    switch (below(4)) {
      case 0:
        return body->soft->addVelocity(anywhere(5));
      case 1:
        return body->soft->setVelocity(anywhere(5));
      case 2:
        return body->soft->addForce(anywhere(20));
      default:
        any_node(*body->soft).m_v = anywhere(10);
    }
  }
  void change_pose() {
    Body* const body = any();
    if (body == nullptr) return;
    switch (below(4)) {
      case 0:
        return body->soft->translate(anywhere(1));
      case 1:
        return body->soft->rotate(btQuaternion(btScalar(between(0, 1)), btScalar(0.2), 0));
      case 2:
        return body->soft->scale(vector(between(0.7, 1.4), between(0.7, 1.4), 1));
      default:
        any_node(*body->soft).m_x += anywhere(0.1);
    }
  }
  void change_config() {
    Body* const body = any();
    if (body == nullptr) return;
    btSoftBody::Config& config = body->soft->m_cfg;
    switch (below(8)) {
      case 0:
        config.kDP = btScalar(between(0, 1));
        break;
      case 1:
        config.kDF = btScalar(between(0, 1));
        break;
      case 2:
        config.kDG = btScalar(between(0, 1));
        break;
      case 3:
        config.kLF = btScalar(between(0, 1));
        break;
      case 4:
        // Bullet divides by the volume: bodies without one that it steps itself it shoots out of every range of numbers.
        if (body->soft->m_faces.size() > 0 && body->soft->getVolume() > btScalar(0.1))
          config.kPR = btScalar(between(-1, 10));
        break;
      case 5:
        config.piterations = 1 + below(5);
        break;
      case 6:
        body->soft->m_materials[0]->m_kLST = btScalar(between(0, 1));
        break;
      default:
        body->soft->getCollisionShape()->setMargin(btScalar(between(0.005, 0.2)));
    }
  }
  void change_links() {
    Body* const body = any();
    if (body == nullptr) return;
    btSoftBody& soft = *body->soft;
    if (soft.m_links.size() == 0) return;
    struct Plane : btSoftBody::ImplicitFn {
      btScalar Eval(const btVector3& x) override { return x.x() - offset; }
      btScalar offset = 0;
    };
    switch (below(4)) {
      case 0: {
        const int first = below(soft.m_nodes.size());
        const int second = below(soft.m_nodes.size());
        if (first != second) soft.appendLink(first, second, nullptr, true);
        break;
      }
      case 1: {
        const btSoftBody::Link& link = soft.m_links[below(soft.m_links.size())];
        if (soft.m_nodes.size() < kMostNodes)
          soft.cutLink(static_cast<int>(link.m_n[0] - &soft.m_nodes[0]),
                       static_cast<int>(link.m_n[1] - &soft.m_nodes[0]), btScalar(0.5));
        break;
      }
      case 2: {
        if (soft.m_nodes.size() >= kMostNodes / 2) break;
        Plane plane;
        plane.offset = soft.m_nodes[0].m_x.x() + btScalar(0.3);
        soft.refine(&plane, btScalar(1e-3), below(2) == 0);
        break;
      }
      default:
        soft.m_links[below(soft.m_links.size())].m_rl *= btScalar(between(0.8, 1.2));
    }
    // Bullet reads beyond the end of a pose of fewer nodes.
    if (soft.m_pose.m_bframe && soft.m_pose.m_pos.size() != soft.m_nodes.size())
      soft.setPose(false, true);
  }
  void change_anchor() {
    Body* const body = any();
    if (body == nullptr) return;
    auto& anchors = body->soft->m_anchors;
    if (anchors.size() > 0 && below(2) == 0) {
      anchors[anchors.size() - 1].m_node->m_battach = 0;
      anchors.pop_back();
      return;
    }
    const int node = below(body->soft->m_nodes.size());
    if (body->soft->m_nodes[node].m_battach != 0) return;
    btRigidBody* const rigid =
        rigids_[static_cast<std::size_t>(below(static_cast<int>(rigids_.size())))].get();
    body->soft->appendAnchor(node, rigid, below(2) == 0, btScalar(between(0.1, 1)));
  }
  void leave() {
    Body* const body = any();
    if (body == nullptr) return;
    if (body->is_in_world) {
      world_.removeSoftBody(body->soft.get());
    } else {
      world_.addSoftBody(body->soft.get());
    }
    body->is_in_world = !body->is_in_world;
  }
  void set_law() {
    Body* const body = any();
    if (body == nullptr) return;
    try {
      switch (below(4)) {
        case 0:
          (void)body->cloth.set(laws::velocity_damping({.rate = between(0, 10)}));
          return;
        case 1:
          (void)body->cloth.set(laws::tension({.stiffness = between(0, 1e4)}));
          return;
        case 2:
          (void)body->cloth.set(laws::hinge_torsion({.rigidity = between(-1e-4, 1e-3)}));
          return;
        default:
          (void)body->cloth.remove("velocity_damping");
      }
    } catch (const InvalidArgument&) {
      // A law that does not suit the mesh, or a value out of its domain: it has changed nothing.
    }
  }
  void ask() {
    Body* const body = any();
    if (body == nullptr) return;
    (void)body->cloth.state();
    (void)body->cloth.laws();
    for (const ClothContactPoint& contact : body->cloth.contacts()) {
      ASSERT_LT(contact.node, body->soft->m_nodes.size());
      ASSERT_TRUE(std::isfinite(contact.impulse.length2()));
    }
    (void)solver_.rigid_contacts(*body->soft);
  }
  // The body needs Bullet's own step, and later not any more.
  void change_kind() {
    Body* const body = any();
    if (body == nullptr) return;
    switch (below(4)) {
      case 0:
        body->soft->m_cfg.timescale = below(2) == 0 ? btScalar(1) : btScalar(0.5);
        break;
      case 1:
        body->soft->m_cfg.kMT = below(2) == 0 ? btScalar(0) : btScalar(0.1);
        body->soft->setPose(false, true);
        break;
      case 2:
        body->soft->activate(true);
        break;
      default:
        solver_.wake(*body->soft);
    }
  }
  void detach() {
    Body* const body = any();
    if (body == nullptr) return;
    if (below(2) == 0) {
      solver_.detach(*body->soft);
    } else if (body->soft->m_faces.size() > 0) {
      solver_.set_cloth_contact(*body->soft, {.with_itself = below(2) == 0,
                                              .with_others = below(2) == 0,
                                              .self_thickness = 0.02,
                                              .margin = 0.02});
    }
  }
  void change_world() {
    world_.getWorldInfo().m_gravity = below(4) == 0 ? anywhere(10) : vector(0, -10, 0);
    world_.getWorldInfo().air_density = btScalar(between(0, 1.2));
  }

  std::mt19937 random_;
  AdoptingSolver solver_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  Constraints constraints_;
  World world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> rigids_;
  std::vector<Body> bodies_;
  int num_blow_ups_ = 0;
  int num_steps_ = 0;
  int num_adopted_steps_ = 0;
};

/// Worlds of 500 calls each: what one call has spoilt does not stay for ever.
template <class World, class Constraints>
void play() {
  constexpr int kCallsOfAWorld = 500;
  const int num_calls = test::count(10000);
  int num_steps = 0;
  int num_adopted_steps = 0;
  for (int world = 0; world < num_calls / kCallsOfAWorld; ++world) {
    SCOPED_TRACE("world " + std::to_string(world));
    Player<World, Constraints> player(static_cast<unsigned>(world + 1));
    for (int call = 0; call < kCallsOfAWorld; ++call) {
      player.call();
      if (::testing::Test::HasFatalFailure()) return;
    }
    num_steps += player.num_steps();
    num_adopted_steps += player.num_adopted_steps();
  }
  EXPECT_GT(num_steps, num_calls / 20);
  EXPECT_GT(num_adopted_steps, num_steps / 3);  // most calls are made of bodies with laws
}

TEST(RandomCalls, DoNoHarmInAWorldOfRigidBodies) {
  play<btSoftRigidDynamicsWorld, btSequentialImpulseConstraintSolver>();
}

TEST(RandomCalls, DoNoHarmInAWorldOfMultibodies) {
  play<btSoftMultiBodyDynamicsWorld, btMultiBodyConstraintSolver>();
}

}  // namespace
}  // namespace weft::bridge
