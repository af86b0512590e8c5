// Handles of cloth: laws, contacts, state, and bodies that are gone.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <weft/bridge/weft.hpp>
#include <weft/core/error.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

using Status = ClothState::Status;

double lowest(const btSoftBody& body) {
  double low = 1e9;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    low = std::min(low, static_cast<double>(body.m_nodes[i].m_x.y()));
  }
  return low;
}

ClothMesh hanging(int n) {
  ClothMesh mesh = cloth(n, 1, 0);
  mesh.pinned = {0, n - 1};
  return mesh;
}

TEST(Cloth, AnEmptyHandleAnswersThatTheBodyIsGone) {
  const Cloth none;
  EXPECT_EQ(none.state().status, Status::kGone);
  EXPECT_EQ(none.body(), nullptr);
  EXPECT_TRUE(none.laws().empty());
  EXPECT_TRUE(none.contacts().empty());
  Cloth copy = none;
  EXPECT_EQ(copy.set(laws::tension({.stiffness = 1.0})), "the body is gone");
  EXPECT_FALSE(copy.on_contact({}));
  EXPECT_FALSE(copy.on_blow_up({}));
}

TEST(Cloth, OutlivesBodyAndSolver) {
  const ClothMesh mesh = hanging(5);
  btSoftBodyWorldInfo info;
  auto solver = std::make_unique<SoftBodySolver>();
  auto first = make_cloth_body(info, mesh, {});
  auto second = make_cloth_body(info, mesh, {});
  const std::vector<forces::LawSpecification> laws{laws::tension({.stiffness = 100.0})};
  ASSERT_FALSE(solver->attach_fast(*first, mesh, laws));
  ASSERT_FALSE(solver->attach_fast(*second, mesh, laws));
  Cloth of_first = solver->cloth(*first);
  Cloth of_second = solver->cloth(*second);
  EXPECT_EQ(of_first.body(), first.get());
  EXPECT_EQ(of_first.state().status, Status::kAwake);
  first.reset();
  EXPECT_EQ(of_first.state().status, Status::kGone);
  EXPECT_EQ(of_first.set(laws::tension({.stiffness = 1.0})), "the body is gone");
  solver.reset();
  EXPECT_EQ(of_second.state().status, Status::kWithoutLaws);
  EXPECT_EQ(of_second.body(), second.get());
  EXPECT_EQ(of_second.set(laws::tension({.stiffness = 1.0})), "the body is without laws");
  EXPECT_TRUE(of_second.contacts().empty());
}

TEST(Cloth, OfABodyWithoutLawsSaysSo) {
  btSoftBodyWorldInfo info;
  SoftBodySolver solver;
  const auto body = make_cloth_body(info, hanging(5), {});
  Cloth cloth = solver.cloth(*body);
  EXPECT_EQ(cloth.state().status, Status::kWithoutLaws);
  EXPECT_EQ(cloth.set(laws::tension({.stiffness = 1.0})), "the body is without laws");
}

// The sag of a stretched sheet is what its stiffness says, in the steps after set() as from the start.
TEST(Cloth, ALawThatIsSetActsFromTheNextStepOn) {
  const auto sag = [](double first, double then) {
    Scene scene(hanging(9),
                {kGravity, law("tension", "stiffness", first), law("velocity_damping", "rate", 5)});
    scene.step(200);
    Cloth cloth = scene.solver().cloth(scene.body());
    EXPECT_EQ(cloth.laws().size(), 3U);
    EXPECT_EQ(cloth.set(laws::tension({.stiffness = then})), std::nullopt);
    EXPECT_EQ(cloth.laws().size(), 3U);
    EXPECT_EQ(cloth.laws()[1].parameters.at("stiffness"), std::vector<double>{then});
    scene.step(400);
    return lowest(scene.body());
  };
  const double stiff = sag(500, 500);
  EXPECT_NEAR(sag(20, 500), stiff, 1e-3);
  EXPECT_LT(sag(500, 20), stiff - 0.01);
}

TEST(Cloth, LawsAreAddedAndTakenAway) {
  Scene scene(hanging(9), {law("tension", "stiffness", 100)});
  Cloth cloth = scene.solver().cloth(scene.body());
  scene.step(10);
  EXPECT_NEAR(scene.momentum().norm(), 0, 1e-6);
  EXPECT_EQ(cloth.set(laws::gravity({.acceleration = {0, -9.81, 0}})), std::nullopt);
  scene.step(10);
  EXPECT_LT(scene.momentum().y(), -0.05);
  EXPECT_EQ(cloth.remove("gravity"), std::nullopt);
  EXPECT_EQ(cloth.laws().size(), 1U);
}

TEST(Cloth, ARefusedLawChangesNothing) {
  Scene scene(hanging(5), {kGravity, law("tension", "stiffness", 100)});
  Cloth cloth = scene.solver().cloth(scene.body());
  try {
    cloth.set(laws::tension({.stiffness = -5.0}));
    FAIL() << "no error";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "tension: stiffness = -5 [N/m], expected >= 0");
  }
  EXPECT_EQ(cloth.laws()[1].parameters.at("stiffness"), std::vector<double>{100.0});
  EXPECT_EQ(cloth.state().status, Status::kAwake);
}

// An adopted body's springs are as long as its links say, whatever law is set.
TEST(Cloth, AnAdoptedBodyKeepsItsRestLengths) {
  SoftWorld world(SoftWorldSettings{});
  std::unique_ptr<btSoftBody> patch(btSoftBodyHelpers::CreatePatch(world.info(), vector(0, 0, 0),
                                                                   vector(1, 0, 0), vector(0, 0, 1),
                                                                   vector(1, 0, 1), 5, 5, 0, true));
  btSoftBody& body = world.add(std::move(patch));
  body.getCollisionShape()->setMargin(btScalar(0.01));
  body.m_worldInfo->m_gravity.setZero();
  world.step(kTimeStep);  // Bullet measures the links of a new body in its first step
  for (int l = 0; l < body.m_links.size(); ++l) body.m_links[l].m_rl *= btScalar(0.8);
  const AdoptionReport report = adopt(world.solver(), body, {.stiffness = 100.0});
  EXPECT_FALSE(report.refusal);
  Cloth cloth = report.cloth;
  ASSERT_EQ(cloth.state().status, Status::kAwake);
  EXPECT_EQ(cloth.set(laws::velocity_damping({.rate = 5.0})), std::nullopt);
  for (int step = 0; step < 300; ++step) world.step(kTimeStep);
  double stretch = 0;  // mean of the links
  for (int l = 0; l < body.m_links.size(); ++l) {
    const btSoftBody::Link& link = body.m_links[l];
    stretch += static_cast<double>((link.m_n[0]->m_x - link.m_n[1]->m_x).length() / link.m_rl) /
               body.m_links.size();
  }
  EXPECT_NEAR(stretch, 1, 0.01);  // 1.25 before the first step
}

TEST(Cloth, ContactsBearTheWeight) {
  constexpr double kMass = 0.25;
  Scene scene(cloth(9, 0.4, kMargin + 1e-4, kMass), {kGravity, law("tension", "stiffness", 500)},
              0.5, {.may_sleep = false});
  btRigidBody& ground = scene.add(box(2, 0.5, 2), 0, at(0, -0.5, 0));
  Cloth cloth = scene.solver().cloth(scene.body());
  int num_calls = 0;
  double last = 0;
  ASSERT_TRUE(cloth.on_contact([&](const std::vector<ClothContactPoint>& contacts) {
    ++num_calls;
    last = 0;
    for (const ClothContactPoint& one : contacts) last += static_cast<double>(one.impulse.y());
  }));
  scene.step(60);
  const std::vector<ClothContactPoint> contacts = cloth.contacts();
  ASSERT_EQ(contacts.size(), 81U);
  double sum = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    EXPECT_EQ(contacts[k].node, static_cast<int>(k));
    EXPECT_EQ(contacts[k].object, &ground);
    EXPECT_NEAR(static_cast<double>(contacts[k].point.y()), 0, 1e-4);
    EXPECT_NEAR(static_cast<double>(contacts[k].normal.y()), 1, 1e-6);
    EXPECT_TRUE(contacts[k].is_sticking);
    sum += static_cast<double>(contacts[k].impulse.y());
  }
  EXPECT_NEAR(sum, kMass * 9.81 * kTimeStep, 1e-3 * sum);
  EXPECT_GE(num_calls, 59);
  EXPECT_DOUBLE_EQ(last, sum);
}

// The drag is twice what mu = 0.5 can hold, so that the cloth slides, and friction is half of the weight.
TEST(Cloth, ContactsThatSlideSaySo) {
  Scene scene(cloth(9, 0.4, kMargin + 1e-4), {kGravity, law("tension", "stiffness", 500)}, 0.5,
              {.may_sleep = false});
  scene.add(box(20, 0.5, 2), 0, at(0, -0.5, 0));
  scene.set_velocity(vector(5, 0, 0));
  scene.step(20);
  btVector3 sum(0, 0, 0);
  for (const ClothContactPoint& one : scene.solver().cloth(scene.body()).contacts()) {
    EXPECT_FALSE(one.is_sticking);
    sum += one.impulse;
  }
  EXPECT_NEAR(static_cast<double>(-sum.x() / sum.y()), 0.5, 0.01);
}

TEST(Cloth, TellsOfSleepAndOfBlowUps) {
  Scene scene(cloth(5, 0.4, kMargin), {kGravity, law("tension", "stiffness", 500)}, 0.5, {});
  scene.add(box(2, 0.5, 2), 0, at(0, -0.5, 0));
  Cloth cloth = scene.solver().cloth(scene.body());
  scene.step(200);
  EXPECT_EQ(cloth.state().status, Status::kAsleep);
  EXPECT_EQ(name_of(cloth.state().status), "asleep");
  std::vector<std::string> reasons;
  ASSERT_TRUE(
      cloth.on_blow_up([&](const BodyBlowUp& blow_up) { reasons.push_back(blow_up.reason); }));
  scene.set_velocity(vector(0, 2e6, 0));
  scene.step(3);
  EXPECT_EQ(cloth.state().status, Status::kBlownUp);
  ASSERT_TRUE(cloth.state().blow_up);
  ASSERT_EQ(reasons.size(), 1U);
  EXPECT_EQ(reasons[0], cloth.state().blow_up->reason);
  const std::optional<std::string> refusal = cloth.set(laws::tension({.stiffness = 1.0}));
  ASSERT_TRUE(refusal);
  EXPECT_THAT(*refusal, ::testing::StartsWith("the body has blown up: "));
}

// A callback may take the body's laws away, which ends itself.
TEST(Cloth, ACallbackMayDetach) {
  Scene scene(cloth(5, 0.4, kMargin), {kGravity, law("tension", "stiffness", 500)}, 0.5, {});
  scene.add(box(2, 0.5, 2), 0, at(0, -0.5, 0));
  Cloth cloth = scene.solver().cloth(scene.body());
  int num_calls = 0;
  ASSERT_TRUE(cloth.on_contact([&](const std::vector<ClothContactPoint>&) {
    ++num_calls;
    scene.solver().detach(scene.body());
  }));
  scene.step(20);
  EXPECT_EQ(num_calls, 1);
  EXPECT_EQ(cloth.state().status, Status::kWithoutLaws);
}

// Callbacks and limits of the program outlast set().
TEST(Cloth, CallbacksStayWhenALawIsSet) {
  Scene scene(cloth(5, 0.4, kMargin), {kGravity, law("tension", "stiffness", 500)}, 0.5,
              {.may_sleep = false});
  scene.add(box(2, 0.5, 2), 0, at(0, -0.5, 0));
  Cloth cloth = scene.solver().cloth(scene.body());
  int num_calls = 0;
  ASSERT_TRUE(cloth.on_contact([&](const std::vector<ClothContactPoint>&) { ++num_calls; }));
  scene.step(10);
  const int before = num_calls;
  EXPECT_EQ(cloth.set(laws::tension({.stiffness = 300.0})), std::nullopt);
  scene.step(10);
  EXPECT_GT(num_calls, before);
}

}  // namespace
}  // namespace weft::bridge
