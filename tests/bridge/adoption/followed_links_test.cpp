// What a program does to the links of a body whose springs are solved for in their place.
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

using ::testing::HasSubstr;

/// A sheet with a link along each spring, in the air, without gravity, damped so that it comes to rest.
class LinkedSheet {
 public:
  LinkedSheet() : world_({.gravity = Vector3<double>::Zero()}) {
    const ClothMesh mesh = cloth(6, 1, 0);
    body_ = &world_.add(
        make_cloth_body(world_.info(), mesh, {.links = {{.edge_sets = {}, .stiffness = 100}}}));
    EXPECT_FALSE(world_.solver().attach_fast(
        *body_, mesh, {law("tension", "stiffness", 100), law("spring_damping", "damping", 2)},
        {.may_sleep = true}));
    step(30);
  }
  void step(int num_steps) {
    for (int i = 0; i < num_steps; ++i) world_.step(kTimeStep);
  }
  btSoftBody& body() { return *body_; }
  SoftBodySolver& solver() { return world_.solver(); }
  /// From a corner of the sheet to the one across [m].
  [[nodiscard]] double diagonal() const {
    return static_cast<double>((body_->m_nodes[35].m_x - body_->m_nodes[0].m_x).length());
  }

 private:
  SoftWorld world_;
  btSoftBody* body_ = nullptr;
};

TEST(FollowedLinks, ASheetWhoseLinksShrinkShrinks) {
  LinkedSheet sheet;
  ASSERT_NEAR(sheet.diagonal(), std::sqrt(2.0), 1e-5);
  for (int l = 0; l < sheet.body().m_links.size(); ++l) {
    sheet.body().m_links[l].m_rl *= btScalar(0.75);
  }
  sheet.step(1);
  EXPECT_LT(sheet.diagonal(), 0.99 * std::sqrt(2.0));  // in the next step, not later
  sheet.step(240);
  EXPECT_NEAR(sheet.diagonal(), 0.75 * std::sqrt(2.0), 1e-3);
}

TEST(FollowedLinks, ASheetAtRestWakesForThem) {
  LinkedSheet sheet;
  sheet.step(120);
  ASSERT_TRUE(sheet.solver().is_asleep(sheet.body()));
  for (int l = 0; l < sheet.body().m_links.size(); ++l) {
    sheet.body().m_links[l].m_rl *= btScalar(1.25);
  }
  sheet.step(240);
  EXPECT_NEAR(sheet.diagonal(), 1.25 * std::sqrt(2.0), 1e-3);
}

TEST(FollowedLinks, ASheetThatIsScaledKeepsItsNewSize) {
  LinkedSheet sheet;
  sheet.body().scale(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5)));
  sheet.step(240);
  EXPECT_NEAR(sheet.diagonal(), 0.5 * std::sqrt(2.0), 1e-3);
}

TEST(FollowedLinks, OneSpringAloneIsFollowed) {
  ClothMesh pair;
  pair.rest_positions.setZero(3, 2);
  pair.rest_positions(1, 1) = -1;
  pair.triangles.resize(3, 0);
  pair.edge_sets.push_back({"spring", (Edges(2, 1) << 0, 1).finished()});
  pair.masses = VectorX<double>::Ones(2);
  pair.pinned = {0};
  SoftWorld world({});
  btSoftBody& body = world.add(
      make_cloth_body(world.info(), pair, {.links = {{.edge_sets = {}, .stiffness = 100}}}));
  ASSERT_FALSE(world.solver().attach_fast(
      body, pair,
      {kGravity, law("tension", "stiffness", 1000), law("spring_damping", "damping", 60)},
      {.may_sleep = false}));
  body.m_links[0].m_rl = btScalar(0.5);
  for (int step = 0; step < 300; ++step) world.step(kTimeStep);
  EXPECT_NEAR(static_cast<double>(-body.m_nodes[1].m_x.y()), 0.5 + 9.81 / 1000, 1e-5);  // m g / k
}

// Bullet measures all links anew after setMass(): a cloth that hangs would take its stretch for its rest.
TEST(FollowedLinks, MassesThatChangeLeaveRestLengthsAsTheyAre) {
  LinkedSheet sheet;
  for (int i = 0; i < sheet.body().m_nodes.size(); ++i) sheet.body().m_nodes[i].m_x *= 2;
  sheet.body().setMass(35, 0.02F);
  sheet.step(400);
  EXPECT_NEAR(sheet.diagonal(), std::sqrt(2.0), 1e-3);
}

TEST(FollowedLinks, LinksThatComeLaterAreReported) {
  LinkedSheet sheet;
  const int num_links = sheet.body().m_links.size();
  sheet.body().appendLink(0, 35);
  sheet.step(1);
  ASSERT_TRUE(sheet.solver().blow_up(sheet.body()));
  EXPECT_THAT(sheet.solver().blow_up(sheet.body())->reason,
              HasSubstr("it has " + std::to_string(num_links + 1) + " links, expected the " +
                        std::to_string(num_links)));
}

TEST(FollowedLinks, ARestLengthThatNoSpringCanHaveIsReported) {
  for (const btScalar value :
       {btScalar(0), btScalar(-1), std::numeric_limits<btScalar>::quiet_NaN()}) {
    LinkedSheet sheet;
    sheet.body().m_links[7].m_rl = value;
    sheet.step(1);
    ASSERT_TRUE(sheet.solver().blow_up(sheet.body()));
    EXPECT_THAT(sheet.solver().blow_up(sheet.body())->reason, HasSubstr("link 7 has m_rl = "));
  }
}

}  // namespace
}  // namespace weft::bridge
