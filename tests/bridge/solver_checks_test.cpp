// What a solver refuses, and how it tells of what went wrong in a step.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/deformable/deformable_world.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>
#include <weft/custom_forces/laws/external/gravity.hpp>
#include <weft/custom_forces/registry.hpp>

#include "tests/bridge/rigid_objects.hpp"

namespace weft::bridge {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kTimeStep = 1.0 / 128;  // [s] exact in single precision
const forces::LawSpecification kGravity{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}};
const forces::LawSpecification kSpring{"tension", {}, {{"stiffness", {100.0}}}};
const forces::LawSpecification kBending{"hinge_torsion", {}, {{"rigidity", {1e-4}}}};

ClothMesh checked_cloth(double height = 0.0) {
  return make_cloth_grid({.nodes = {4, 4}, .center = {0, height, 0}, .total_mass = 0.16});
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "no error";
}

/// The error of attaching a mesh to a body of checked_cloth(). Expects the same one from each way to attach.
std::string error_of_attaching(const ClothMesh& mesh) {
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
  DeformableWorld deformable({});
  btSoftBody& other = deformable.add(make_cloth_body(deformable.info(), checked_cloth(), {}));
  const std::vector<forces::LawSpecification> laws{kSpring, kBending};
  const std::string error = error_of([&] { world.solver().attach(body, mesh, laws); });
  EXPECT_EQ(error_of([&] { (void)world.solver().attach_fast(body, mesh, laws); }), error);
  EXPECT_FALSE(world.solver().has_laws(body));
  EXPECT_NE(error_of([&] { deformable.forces().attach(other, mesh, laws); }), "no error");
  EXPECT_FALSE(deformable.forces().has_laws(other));
  return error;
}

bool is_finite(const btSoftBody& body) {
  btScalar sum = 0;
  for (int i = 0; i < body.m_nodes.size(); ++i)
    sum += body.m_nodes[i].m_x.length2() + body.m_nodes[i].m_v.length2();
  return std::isfinite(sum);
}

/// With springs that the solver takes in hand, or with gravity as a force on Bullet's own step.
void attach_checked_cloth(SoftWorld& world, btSoftBody& body, bool is_fast) {
  if (is_fast) {
    EXPECT_FALSE(world.solver().attach_fast(body, checked_cloth(), {kSpring}));
  } else {
    world.solver().attach(body, checked_cloth(), {kGravity});
  }
}

void expect_that_it_fits(const ClothMesh& mesh) {
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
  EXPECT_NO_THROW(world.solver().attach(body, mesh, {kSpring, kBending}));
}

TEST(SolverChecks, IndicesOutOfRangeAreNamed) {
  ClothMesh mesh = checked_cloth();
  mesh.triangles(0, 2) = 5000;
  EXPECT_THAT(error_of_attaching(mesh), HasSubstr("triangle 2 names node 5000, expected 0 to 15"));
  mesh = checked_cloth();
  mesh.crossed_triangles(1, 0) = -1;
  EXPECT_THAT(error_of_attaching(mesh),
              HasSubstr("crossed triangle 0 names node -1, expected 0 to 15"));
  mesh = checked_cloth();
  mesh.edge_sets[0].edges(1, 3) = 16;
  EXPECT_THAT(error_of_attaching(mesh), AllOf(HasSubstr(mesh.edge_sets[0].name),
                                              HasSubstr("edge 3 names node 16, expected 0 to 15")));
  mesh = checked_cloth();
  mesh.line_sets[0].triples(2, 0) = 99;
  EXPECT_THAT(error_of_attaching(mesh), HasSubstr("triple 0 names node 99, expected 0 to 15"));
  mesh = checked_cloth();
  mesh.node_sets = {{"hand", {16}}};
  EXPECT_THAT(error_of_attaching(mesh),
              HasSubstr("node set 'hand' names node 16, expected 0 to 15"));
}

TEST(SolverChecks, TrianglesThatAreNotTheBodysAreRefused) {
  ClothMesh mesh = checked_cloth();
  std::swap(mesh.triangles(0, 0), mesh.triangles(0, mesh.triangles.cols() - 1));
  EXPECT_THAT(error_of_attaching(mesh), HasSubstr("expected the same triangles"));
  mesh = checked_cloth();
  mesh.triangles.conservativeResize(3, 5);
  EXPECT_THAT(error_of_attaching(mesh),
              HasSubstr("a mesh of 5 triangles, expected the 18 faces of the body, or none"));
  // Neither their order matters nor where each begins.
  mesh = checked_cloth();
  mesh.triangles = mesh.triangles.rowwise().reverse().eval();
  mesh.triangles = mesh.triangles.colwise().reverse().eval();
  expect_that_it_fits(mesh);
}

TEST(SolverChecks, MassesThatAreNotTheBodysAreRefused) {
  ClothMesh mesh = checked_cloth();
  mesh.masses[7] *= 1.01;
  EXPECT_THAT(error_of_attaching(mesh),
              AllOf(HasSubstr("mass of node 7 = "), HasSubstr("expected the body's")));
  mesh = checked_cloth();
  mesh.masses[7] *= 1 + 1e-6;
  expect_that_it_fits(mesh);
}

TEST(SolverChecks, FastSettingsOutOfTheirDomainAreRefused) {
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
  btSoftBody& fast = world.add(make_cloth_body(world.info(), checked_cloth(3), {}));
  ASSERT_FALSE(world.solver().attach_fast(fast, checked_cloth(3), {kSpring}));
  for (const double value : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (const FastSettings& settings :
         {FastSettings{.sleep_speed = value}, FastSettings{.sleep_time = value}}) {
      EXPECT_THAT(error_of([&] {
                    (void)world.solver().attach_fast(body, checked_cloth(), {kSpring}, settings);
                  }),
                  AllOf(HasSubstr("sleep_"), HasSubstr("expected >= 0 and finite")));
      EXPECT_THAT(error_of([&] { world.solver().set_fast_settings(fast, settings); }),
                  HasSubstr("sleep_"));
    }
  }
  EXPECT_THAT(error_of([&] {
                world.solver().set_fast_settings(
                    fast, {.solver = {.newton_iterations = 2, .linear_iterations = 0}});
              }),
              HasSubstr("solver.linear_iterations = 0, expected >= 1"));
  EXPECT_FALSE(world.solver().has_laws(body));
}

/// What makes a body one that cannot be fast, and what is said of it.
struct Refusal {
  void (*make)(btSoftBody& body);
  std::string reason;
};

std::vector<Refusal> refusals_at_any_time() {
  return {
      {[](btSoftBody& body) { body.generateClusters(1); }, "clusters"},
      {[](btSoftBody& body) {
         body.setPose(false, true);
         body.m_cfg.kMT = btScalar(0.5);
       },
       "pose"},
      {[](btSoftBody& body) { body.m_cfg.timescale = btScalar(0.5); }, "timescale"},
  };
}

TEST(SolverChecks, WhatCannotBeFastIsRefusedAndLeftAsItWas) {
  std::vector<Refusal> refusals = refusals_at_any_time();
  refusals.push_back({[](btSoftBody& body) { body.appendLink(0, 5); }, "1 links"});
  for (const Refusal& refusal : refusals) {
    SoftWorld world({});
    world.info().m_gravity.setValue(0, btScalar(-9.81), 0);
    btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
    SoftWorld plain({});
    plain.info().m_gravity.setValue(0, btScalar(-9.81), 0);
    btSoftBody& same = plain.add(make_cloth_body(plain.info(), checked_cloth(), {}));
    for (btSoftBody* each : {&body, &same}) refusal.make(*each);
    const auto reason = world.solver().attach_fast(body, checked_cloth(), {kBending});
    ASSERT_TRUE(reason) << refusal.reason;
    EXPECT_THAT(*reason, HasSubstr(refusal.reason));
    EXPECT_FALSE(world.solver().has_laws(body));
    for (int step = 0; step < 5; ++step) {
      world.step(kTimeStep);
      plain.step(kTimeStep);
    }
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      EXPECT_EQ(body.m_nodes[i].m_x, same.m_nodes[i].m_x) << refusal.reason;
    }
  }
}

TEST(SolverChecks, WhatCannotBeFastAnyMoreIsReported) {
  for (const Refusal& refusal : refusals_at_any_time()) {
    SoftWorld world({});
    btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
    ASSERT_FALSE(world.solver().attach_fast(body, checked_cloth(), {kSpring}));
    world.step(kTimeStep);
    EXPECT_FALSE(world.solver().blow_up(body));
    refusal.make(body);
    world.step(kTimeStep);
    ASSERT_TRUE(world.solver().blow_up(body)) << refusal.reason;
    EXPECT_THAT(world.solver().blow_up(body)->reason, HasSubstr(refusal.reason));
  }
}

TEST(SolverChecks, ATimescaleThatExplicitLawsDoNotKnowIsReported) {
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
  world.solver().attach(body, checked_cloth(), {kGravity});
  world.step(kTimeStep);
  EXPECT_FALSE(world.solver().blow_up(body));
  body.m_cfg.timescale = btScalar(0.5);
  world.step(kTimeStep);
  ASSERT_TRUE(world.solver().blow_up(body));
  EXPECT_THAT(world.solver().blow_up(body)->reason, HasSubstr("timescale = 0.5"));
}

// Bullet divides by the volume, which is none. Without a word its velocities are not numbers.
TEST(SolverChecks, PressureInASheetThatLiesFlatIsReported) {
  for (const bool is_fast : {false, true}) {
    SoftWorld world({});
    btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
    attach_checked_cloth(world, body, is_fast);
    body.m_cfg.kPR = 5;
    world.step(kTimeStep);
    ASSERT_TRUE(world.solver().blow_up(body)) << is_fast;
    EXPECT_THAT(world.solver().blow_up(body)->reason,
                AllOf(HasSubstr("m_cfg.kPR = 5"), HasSubstr("m^3")));
    EXPECT_TRUE(is_finite(body)) << is_fast;
  }
}

TEST(SolverChecks, LinksThatATensionLawStandsInForAreNoObstacle) {
  SoftWorld world({});
  btSoftBody& body =
      world.add(make_cloth_body(world.info(), checked_cloth(), {.links = {{{}, 100.0}}}));
  EXPECT_FALSE(world.solver().attach_fast(body, checked_cloth(), {kSpring}));
  EXPECT_TRUE(world.solver().is_fast(body));
}

TEST(SolverChecks, ABlowUpIsToldOnceToTheCallback) {
  SoftWorld world({});
  btSoftBody& calm = world.add(make_cloth_body(world.info(), checked_cloth(5), {}));
  btSoftBody& wild = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
  btSoftBody& fast = world.add(make_cloth_body(world.info(), checked_cloth(10), {}));
  world.solver().attach(calm, checked_cloth(5), {kGravity});
  world.solver().attach(wild, checked_cloth(), {kGravity});
  ASSERT_FALSE(world.solver().attach_fast(fast, checked_cloth(10), {kSpring, kGravity}));
  std::vector<std::pair<btSoftBody*, BodyBlowUp>> told;
  world.solver().set_on_blow_up([&](btSoftBody& body, const BodyBlowUp& blow_up) {
    told.emplace_back(&body, blow_up);
    world.solver().detach(body);  // it may use the solver
  });
  world.step(kTimeStep);
  EXPECT_TRUE(told.empty());
  wild.m_nodes[7].m_v.setX(std::numeric_limits<btScalar>::quiet_NaN());
  fast.m_nodes[3].m_v.setX(btScalar(1e7));
  for (int step = 0; step < 3; ++step) {
    world.step(kTimeStep);
    if (!told.empty()) wild.m_nodes[7].m_v.setZero();  // Bullet's from now on
  }
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].first, &wild);
  EXPECT_EQ(told[0].second.node, 7);
  EXPECT_EQ(told[1].first, &fast);
  EXPECT_THAT(told[1].second.reason, HasSubstr("speed"));
  EXPECT_FALSE(world.solver().blow_up(calm));
}

// A body that Bullet steps itself and that blows up gives rigid bodies at its anchors such velocities.
TEST(SolverChecks, ARigidBodyWhoseVelocityIsNotFiniteIsNotMet) {
  for (const bool is_fast : {false, true}) {
    SoftWorld world({});
    btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
    attach_checked_cloth(world, body, is_fast);
    btRigidBody& ball =
        add_rigid(world, std::make_shared<btSphereShape>(btScalar(0.5)), 1, at(0, 0, 0));
    ball.setLinearVelocity(vector(std::numeric_limits<double>::quiet_NaN(), 0, 0));
    for (int step = 0; step < 20; ++step) world.step(kTimeStep);
    EXPECT_FALSE(world.solver().blow_up(body)) << is_fast;
    EXPECT_TRUE(is_finite(body)) << is_fast;
  }
}

TEST(SolverChecks, AnAnchorOnARigidBodyThatIsNotFiniteIsReportedInThatStep) {
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
  ASSERT_FALSE(world.solver().attach_fast(body, checked_cloth(), {kSpring}));
  btRigidBody& ball =
      add_rigid(world, std::make_shared<btSphereShape>(btScalar(0.1)), 1, at(0, 5, 0));
  body.appendAnchor(0, &ball);
  world.step(kTimeStep);
  ASSERT_FALSE(world.solver().blow_up(body));
  ball.setLinearVelocity(vector(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  world.step(kTimeStep);
  ASSERT_TRUE(world.solver().blow_up(body));
  EXPECT_THAT(world.solver().blow_up(body)->reason, HasSubstr("not finite"));
  EXPECT_TRUE(is_finite(body));
  for (int step = 0; step < 20; ++step) world.step(kTimeStep);
  EXPECT_TRUE(is_finite(body));
}

/// A law with a fault in it, which shows once a node has fallen below a height.
class FaultyLaw final : public forces::ForceLaw<btScalar> {
 public:
  explicit FaultyLaw(double height) : height_(height) {}
  [[nodiscard]] const forces::LawInfo& info() const noexcept override {
    return forces::Gravity<btScalar>::kInfo;
  }
  void add_forces(const forces::State<btScalar>& state, Matrix3XRef<btScalar> /*scratch*/,
                  Matrix3XRef<btScalar> /*forces*/) const override {
    if (static_cast<double>(state.positions.row(1).minCoeff()) < height_) {
      throw std::runtime_error("the law has a fault");
    }
  }

 private:
  double height_;  // [m]
};

forces::LawSet<btScalar> faulty_laws(double height) {
  forces::LawSet<btScalar> laws;
  laws.add(forces::make_law<btScalar>(kGravity, checked_cloth()));
  laws.add(std::make_unique<FaultyLaw>(height));
  return laws;
}

TEST(SolverChecks, AnExceptionOfALawStopsItsBodyAndNoStep) {
  for (const bool is_deferred : {false, true}) {
    SoftWorld world({});
    world.solver().set_deferred(is_deferred);
    btSoftBody& faulty = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
    btSoftBody& good = world.add(make_cloth_body(world.info(), checked_cloth(5), {}));
    const VectorX<btScalar> masses = checked_cloth().masses.cast<btScalar>();
    world.solver().attach(faulty, faulty_laws(-0.01), masses);
    world.solver().attach(good, checked_cloth(5), {kGravity});
    int num_told = 0;
    world.solver().set_on_blow_up([&](btSoftBody& body, const BodyBlowUp& blow_up) {
      ++num_told;
      EXPECT_EQ(&body, &faulty);
      EXPECT_EQ(blow_up.node, -1);
      EXPECT_EQ(blow_up.reason, "the law has a fault");
    });
    const int num_steps = 20;
    for (int step = 0; step < num_steps; ++step) ASSERT_NO_THROW(world.step(kTimeStep));
    EXPECT_EQ(num_told, 1);
    const double fallen = 9.81 * kTimeStep * kTimeStep * num_steps * (num_steps + 1) / 2;
    EXPECT_NEAR(static_cast<double>(good.m_nodes[0].m_x.y()), 5 - fallen, 1e-4);
    // It stays where it was when the law was asked: one step's way below the height, at most.
    EXPECT_NEAR(static_cast<double>(faulty.m_nodes[0].m_x.y()), -0.01, 0.01);
  }
}

TEST(SolverChecks, AnExceptionOfALawStopsItsBodyOfTheDeformableWorldToo) {
  DeformableWorld world({});
  btSoftBody& faulty = world.add(make_cloth_body(world.info(), checked_cloth(), {}));
  btSoftBody& good = world.add(make_cloth_body(world.info(), checked_cloth(5), {}));
  world.forces().attach(faulty, faulty_laws(-0.01), checked_cloth().masses.cast<btScalar>());
  world.forces().attach(good, checked_cloth(5), {kGravity});
  int num_told = 0;
  world.forces().set_on_blow_up([&](btSoftBody& body, const BodyBlowUp& blow_up) {
    ++num_told;
    EXPECT_EQ(&body, &faulty);
    EXPECT_EQ(blow_up.reason, "the law has a fault");
  });
  for (int step = 0; step < 20; ++step) ASSERT_NO_THROW(world.step(kTimeStep));
  EXPECT_EQ(num_told, 1);
  EXPECT_LT(static_cast<double>(good.m_nodes[0].m_x.y()), 5 - 0.1);
  EXPECT_NEAR(static_cast<double>(faulty.m_nodes[0].m_x.y()), -0.01, 0.01);
}

// A patch of an existing program with VF_SS, as in every demo of Bullet, falls on another one.
TEST(SolverChecks, FastBodiesWithBulletsFaceContactMeetGently) {
  for (const bool both_fast : {true, false}) {
    SoftWorld world({});
    world.info().m_gravity.setValue(0, btScalar(-9.81), 0);
    ClothMesh low = make_cloth_grid({.nodes = {21, 21}, .size = {2, 2}, .total_mass = 0.5});
    low.pinned = {0, 20, 420, 440};
    const ClothMesh high = make_cloth_grid(
        {.nodes = {11, 11}, .size = {1, 1}, .center = {0, 0.5, 0}, .total_mass = 0.2});
    const forces::LawSpecification tension{"tension", {}, {{"stiffness", {200.0}}}};
    const ClothSettings settings{.collision_margin = 0.05, .links = {{{}, 200.0}}};
    btSoftBody& below = world.add(make_cloth_body(world.info(), low, settings));
    btSoftBody& above = world.add(make_cloth_body(world.info(), high, settings));
    for (btSoftBody* body : {&below, &above}) {
      body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    }
    ASSERT_FALSE(world.solver().attach_fast(above, high, {tension}));
    if (both_fast) {
      ASSERT_FALSE(world.solver().attach_fast(below, low, {tension}));
    }
    double fastest = 0;
    for (int step = 0; step < 240; ++step) {
      world.step(1.0 / 60);
      for (int i = 0; i < above.m_nodes.size(); ++i) {
        fastest = std::max(fastest, static_cast<double>(above.m_nodes[i].m_v.length()));
      }
    }
    EXPECT_LT(fastest, 6) << both_fast;  // a fall of half a metre and the sag: 3.1 to 4.5 m/s
    EXPECT_FALSE(world.solver().blow_up(above));
  }
}

}  // namespace
}  // namespace weft::bridge
