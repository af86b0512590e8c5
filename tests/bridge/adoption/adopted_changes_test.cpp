// The changes that a Bullet program makes to its bodies at run time show in the next steps of adopted ones.
#include <weft/bridge/adoption/adopting_solver.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <weft/custom_forces/typed_laws.hpp>

#include "tests/bridge/bullet_scenes.hpp"
#include "tests/bridge/rigid_objects.hpp"

namespace weft::bridge {
namespace {

using testing::PlainWorld;

constexpr double kChangesStep = 1.0 / 60;  // [s]
constexpr double kChangesGravity = 10;     // [m/s^2] of PlainWorld

class AdoptedChanges : public ::testing::Test {
 protected:
  AdoptedChanges() : world(&solver) {
    solver.set_on_adoption([this](btSoftBody&, const AdoptionReport& report) {
      (report.refusal ? num_refused : num_adopted) += 1;
    });
    solver.set_on_blow_up([](btSoftBody&, const BodyBlowUp& blow_up) {
      ADD_FAILURE() << "stopped: " << blow_up.reason;
    });
  }

  btSoftBodyWorldInfo& info() { return world.world.getWorldInfo(); }
  void run(double seconds) {
    const int num_steps = static_cast<int>(std::lround(seconds / kChangesStep));
    for (int step = 0; step < num_steps; ++step) {
      world.world.stepSimulation(static_cast<btScalar>(kChangesStep), 0);
    }
  }
  /// 2 m x 2 m of 13 x 13 nodes at a height of 2 m, 1 kg.
  btSoftBody& add_sheet(int fixed) {
    btSoftBody* const sheet =
        btSoftBodyHelpers::CreatePatch(info(), vector(-1, 2, -1), vector(1, 2, -1),
                                       vector(-1, 2, 1), vector(1, 2, 1), 13, 13, fixed, true);
    sheet->setTotalMass(1);
    sheet->getCollisionShape()->setMargin(btScalar(0.02));
    return *world.add(sheet);
  }
  /// Five nodes of 1 kg below each other, 0.25 m a link; the first is held at a height of 5 m.
  btSoftBody& add_rope(double link_factor) {
    btSoftBody* const rope =
        btSoftBodyHelpers::CreateRope(info(), vector(0, 5, 0), vector(0, 4, 0), 3, 1);
    for (int i = 1; i < rope->m_nodes.size(); ++i) rope->setMass(i, 1);
    rope->m_materials[0]->m_kLST = btScalar(link_factor);
    rope->m_cfg.kDP = btScalar(0.05);
    return *world.add(rope);
  }
  btRigidBody& add_floor() {
    return *world.add_rigid(std::make_unique<btBoxShape>(vector(20, 1, 20)), 0, vector(0, -1, 0));
  }
  static double height(const btSoftBody& body, int node) {
    return static_cast<double>(body.m_nodes[node].m_x.y());
  }
  static double lowest(const btSoftBody& body) {
    double low = height(body, 0);
    for (int i = 0; i < body.m_nodes.size(); ++i) low = std::min(low, height(body, i));
    return low;
  }

  AdoptingSolver solver;
  PlainWorld world;
  int num_adopted = 0;
  int num_refused = 0;
};

constexpr int kFourCorners = 1 + 2 + 4 + 8;
constexpr int kMiddle = 6 * 13 + 6;

TEST_F(AdoptedChanges, AMaterialThatGetsSofterStretches) {
  btSoftBody& rope = add_rope(0.9);
  run(4);
  const double stiff = 5 - height(rope, 4);
  rope.m_materials[0]->m_kLST = btScalar(0.2);
  run(8);
  const double soft = 5 - height(rope, 4);
  // The map of bridge/link_stiffness.hpp, link by link: 4, 3, 2, 1 kg hang there; the first has one end that does not move.
  const auto sag = [&](double factor) {
    const double ratio = 1 / (1 - factor) - 1;
    const double reduced = (1 + 0.5 + 0.5 + 0.5) / 4;  // adoption takes the mean of a material
    return 1 + kChangesGravity * kChangesStep * kChangesStep * (4 + 3 + 2 + 1) / (ratio * reduced);
  };
  EXPECT_NEAR(stiff, sag(0.9), 2e-3);
  EXPECT_NEAR(soft, sag(0.2), 2e-2);
  EXPECT_EQ(num_adopted, 2);
  rope.m_cfg.piterations = 4;  // which make links stiffer in Bullet, too
  run(6);
  EXPECT_LT(5 - height(rope, 4), soft - 0.02);
}

TEST_F(AdoptedChanges, ALinkThatIsAppendedHolds) {
  btSoftBody& rope = add_rope(0.05);
  run(3);
  const double before = 5 - height(rope, 4);
  btSoftBody::Material* const stiff = rope.appendMaterial();
  stiff->m_kLST = btScalar(1);
  rope.appendLink(0, 4, stiff);
  info().m_gravity = vector(0, -20, 0);
  run(3);
  EXPECT_GT(before, 1.3);
  // Bullet measures all links anew where one is appended: without it the rope would hang twice as far below where it was.
  EXPECT_NEAR(5 - height(rope, 4), before, 0.02);
}

/// Cuts along the plane x = 0.05.
struct CutPlane : btSoftBody::ImplicitFn {
  btScalar Eval(const btVector3& x) override { return x.x() - btScalar(0.05); }
};

TEST_F(AdoptedChanges, ASheetThatIsRefinedAndCutHangsInTwo) {
  btSoftBody& sheet = add_sheet(kFourCorners);
  solver.set_cloth_contact(sheet, {.with_itself = true, .self_thickness = 0.02});
  run(1);
  const double before = lowest(sheet);
  const int num_nodes = sheet.m_nodes.size();
  CutPlane plane;
  sheet.refine(&plane, btScalar(1e-4), true);
  ASSERT_GT(sheet.m_nodes.size(), num_nodes);
  const std::optional<std::string> refusal =
      solver.cloth(sheet).set(laws::tension({.stiffness = 100.0}));
  ASSERT_TRUE(refusal);
  EXPECT_THAT(*refusal, ::testing::HasSubstr("nodes since the last step"));
  run(3);
  EXPECT_TRUE(solver.has_laws(sheet));
  EXPECT_LT(lowest(sheet), before - 0.3);  // its middle is not held from the other side any more
}

TEST_F(AdoptedChanges, ALinkThatIsCutLetsGo) {
  btSoftBody& rope = add_rope(1);
  run(1);
  ASSERT_TRUE(rope.cutLink(2, 3, btScalar(0.5)));
  run(0.5);
  EXPECT_NEAR(height(rope, 2), 4.5, 0.05);
  EXPECT_LT(height(rope, 4), 3.5);  // falls by 1.25 m, less what kDP takes
}

TEST_F(AdoptedChanges, WhatNeedsBulletGoesToBulletAndComesBack) {
  struct Change {
    std::string name;
    std::function<void(btSoftBody&)> make;
    std::function<void(btSoftBody&)> undo;
  };
  const std::vector<Change> changes = {
      {"clusters", [](btSoftBody& body) { body.generateClusters(4); },
       [](btSoftBody& body) { body.releaseClusters(); }},
      {"pose",
       [](btSoftBody& body) {
         body.m_cfg.kMT = btScalar(0.1);
         body.setPose(false, true);
       },
       [](btSoftBody& body) { body.m_cfg.kMT = 0; }},
      {"timescale", [](btSoftBody& body) { body.m_cfg.timescale = btScalar(0.5); },
       [](btSoftBody& body) { body.m_cfg.timescale = 1; }},
  };
  for (const Change& change : changes) {
    btSoftBody& sheet = add_sheet(1 + 2);
    run(0.2);
    EXPECT_TRUE(solver.has_laws(sheet)) << change.name;
    const double before = lowest(sheet);
    change.make(sheet);
    run(0.2);
    EXPECT_FALSE(solver.has_laws(sheet)) << change.name;
    EXPECT_LT(lowest(sheet), before - 0.05) << change.name;  // it goes on falling
    change.undo(sheet);
    run(0.1);
    EXPECT_TRUE(solver.has_laws(sheet)) << change.name;
    world.world.removeSoftBody(&sheet);
  }
  EXPECT_EQ(num_adopted, 6);
  EXPECT_EQ(num_refused, 3);
}

TEST_F(AdoptedChanges, AnchorsHoldUntilTheyAreRemoved) {
  btRigidBody& post =
      *world.add_rigid(std::make_unique<btBoxShape>(vector(0.1, 0.1, 0.1)), 0, vector(0, 9, 0));
  btSoftBody& sheet = add_sheet(0);
  run(0.1);
  const double held_at = height(sheet, kMiddle);
  sheet.appendAnchor(kMiddle, &post);
  run(1);
  EXPECT_NEAR(height(sheet, kMiddle), held_at, 1e-3);
  sheet.m_anchors.pop_back();
  sheet.m_nodes[kMiddle].m_battach = 0;
  run(0.3);
  EXPECT_LT(height(sheet, kMiddle), held_at - 0.3);
}

TEST_F(AdoptedChanges, PinsHoldUntilTheyAreLetGo) {
  btSoftBody& sheet = add_sheet(0);
  run(0.1);
  const double held_at = height(sheet, 0);
  sheet.setMass(0, 0);
  sheet.m_nodes[0].m_v.setZero();  // with which it would go on, as in Bullet
  run(0.5);
  EXPECT_EQ(height(sheet, 0), held_at);
  sheet.setMass(0, btScalar(1.0 / 169));
  run(0.3);
  EXPECT_LT(height(sheet, 0), held_at - 0.2);
}

TEST_F(AdoptedChanges, ABodyThatIsMovedGoesOnAsFastFromThere) {
  btSoftBody& sheet = add_sheet(0);
  run(0.5);
  const double speed = static_cast<double>(sheet.m_nodes[kMiddle].m_v.y());
  sheet.translate(vector(3, 10, 0));
  const double start = height(sheet, kMiddle);
  run(kChangesStep);
  EXPECT_NEAR(height(sheet, kMiddle) - start,
              (speed - kChangesGravity * kChangesStep) * kChangesStep, 1e-3);
  sheet.rotate(btQuaternion(vector(1, 0, 0), btScalar(1)));
  const btVector3 across = sheet.m_nodes[0].m_x - sheet.m_nodes[168].m_x;
  run(0.2);
  EXPECT_LT((sheet.m_nodes[0].m_x - sheet.m_nodes[168].m_x - across).length(), btScalar(0.05));
}

TEST_F(AdoptedChanges, AMarginCountsFromTheNextStepOn) {
  add_floor();
  btSoftBody& sheet = add_sheet(0);
  run(1.5);
  EXPECT_NEAR(lowest(sheet), 0.02, 2e-3);
  sheet.getCollisionShape()->setMargin(btScalar(0.1));
  sheet.activate(true);
  run(1);
  EXPECT_NEAR(lowest(sheet), 0.1, 3e-3);
}

TEST_F(AdoptedChanges, AFilterLetsItFallThrough) {
  add_floor();
  btSoftBody& sheet = add_sheet(0);
  run(1.5);
  world.world.removeSoftBody(&sheet);
  world.world.addSoftBody(&sheet, btBroadphaseProxy::DefaultFilter, 0);
  run(1);
  EXPECT_TRUE(solver.has_laws(sheet));
  EXPECT_LT(lowest(sheet), -3);
}

TEST_F(AdoptedChanges, GravityAndForcesActAtOnce) {
  btSoftBody& sheet = add_sheet(0);
  run(0.1);
  info().m_gravity = vector(0, 0, 0);
  sheet.setVelocity(vector(0, 0, 0));
  run(0.1);
  EXPECT_LT(sheet.m_nodes[kMiddle].m_v.length(), btScalar(1e-3));
  sheet.addForce(vector(0, 0, 6));  // on each node, for one step
  run(kChangesStep);
  EXPECT_NEAR(static_cast<double>(sheet.m_nodes[kMiddle].m_v.z()), 6 * 169 * kChangesStep,
              0.01 * 17);
  sheet.setVelocity(vector(1, 0, 0));
  run(0.5);
  EXPECT_NEAR(static_cast<double>(sheet.m_nodes[kMiddle].m_v.x()), 1, 1e-2);
}

TEST_F(AdoptedChanges, ABodyAtRestWakesForWhatTheProgramDoes) {
  add_floor();
  btSoftBody& sheet = add_sheet(0);
  run(6);
  ASSERT_TRUE(solver.is_asleep(sheet));
  sheet.addVelocity(vector(0, 4, 0));
  run(0.2);
  EXPECT_GT(lowest(sheet), 0.3);
}

}  // namespace
}  // namespace weft::bridge
