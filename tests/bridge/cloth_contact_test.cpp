#include <weft/bridge/cloth_contact.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/face_grid.hpp>
#include <weft/bridge/node_state.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/custom_forces/core/error.hpp>

namespace weft::bridge {
namespace {

constexpr double kTimeStep = 1.0 / 512;  // [s] exact in single precision
constexpr double kMargin = 0.01;         // [m]
constexpr double kThickness = 2 * kMargin;

ClothMesh square(double height, double turn) {
  ClothGrid grid;
  grid.nodes = {13, 13};
  grid.size = {0.36, 0.36};
  grid.total_mass = 0.05;
  grid.lumping = MassLumping::kUniform;
  grid.center = {0, height, 0};
  grid.u_axis = {std::cos(turn), 0, std::sin(turn)};
  grid.v_axis = {std::sin(turn), 0, -std::cos(turn)};
  return make_cloth_grid(grid);
}

ClothSettings linked() {
  return {.collision_margin = kMargin, .links = {{{}, 20.0}}, .time_step = kTimeStep};
}

Matrix3X<btScalar> positions(const btSoftBody& body) {
  Matrix3X<btScalar> x;
  Matrix3X<btScalar> v;
  read_nodes(body, x, v);
  return x;
}

Matrix3X<btScalar> velocities(const btSoftBody& body) {
  Matrix3X<btScalar> x;
  Matrix3X<btScalar> v;
  read_nodes(body, x, v);
  return v;
}

void throw_down(btSoftBody& body, double speed) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    body.m_nodes[i].m_v.setValue(0, static_cast<btScalar>(-speed), 0);
  }
}

enum class Contact { kNone, kWeft, kBullet };

void make_contact(Contact contact, SoftWorld& world, btSoftBody& body) {
  if (contact == Contact::kWeft) {
    world.solver().set_cloth_contact(body, {.with_others = true, .margin = kMargin});
  } else if (contact == Contact::kBullet) {
    body.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    body.initializeFaceTree();
  }
}

struct Meeting {
  int num_through = 0;    // nodes of the thrown cloth that end below the other one
  double rebound = 0.0;   // [m/s] mean speed upwards at the end
  double momentum = 0.0;  // [kg m/s] of both, per approach momentum, change
  Matrix3X<btScalar> end;
};

/// A cloth is thrown at another one, without gravity. held: the other one is pinned everywhere.
Meeting meet(Contact contact, double speed, bool held) {
  const ClothMesh upper = square(0.05, 0.3);
  ClothMesh lower = square(0.0, 0.0);
  if (held) {
    lower.pinned.resize(static_cast<std::size_t>(lower.num_nodes()));
    std::iota(lower.pinned.begin(), lower.pinned.end(), 0);
  }
  SoftWorld world({.gravity = {0, 0, 0}});
  btSoftBody& below = world.add(make_cloth_body(world.info(), lower, linked()));
  btSoftBody& above = world.add(make_cloth_body(world.info(), upper, linked()));
  make_contact(contact, world, below);
  make_contact(contact, world, above);
  throw_down(above, speed);
  const auto num_steps = static_cast<int>(std::lround(0.12 / speed / kTimeStep));
  for (int step = 0; step < num_steps; ++step) world.step(kTimeStep);
  Meeting result;
  result.end = positions(above);
  const double floor = static_cast<double>(positions(below).row(1).mean());
  result.num_through = static_cast<int>((result.end.row(1).array() < btScalar(floor)).count());
  result.rebound = static_cast<double>(velocities(above).row(1).mean());
  result.momentum = result.rebound + static_cast<double>(velocities(below).row(1).mean()) + speed;
  result.momentum /= speed;
  return result;
}

TEST(ClothContact, AThrownClothStopsOnAHeldOne) {
  for (const double speed : {0.5, 2.0, 8.0}) {
    const Meeting meeting = meet(Contact::kWeft, speed, true);
    EXPECT_EQ(meeting.num_through, 0) << speed;
    EXPECT_GT(meeting.end.row(1).minCoeff(), btScalar(0.5 * kThickness)) << speed;
    // A stop, not a bounce: a tenth of the approach at most, from the links.
    EXPECT_LT(meeting.rebound, 0.1 * speed) << speed;
    EXPECT_EQ(meet(Contact::kNone, speed, true).num_through, meeting.end.cols()) << speed;
  }
}

// What ClothContact's comment says of Bullet's own contact.
TEST(ClothContact, BulletsOwnThrowsClothsApart) {
  const Meeting weft = meet(Contact::kWeft, 2.0, true);
  const Meeting bullet = meet(Contact::kBullet, 2.0, true);
  RecordProperty("bullet_rebound", std::to_string(bullet.rebound));
  RecordProperty("bullet_through", bullet.num_through);
  std::printf("Bullet VF_SS: rebound %.3f m/s, through %d of %d; Weft: %.3f m/s, %d\n",
              bullet.rebound, bullet.num_through, static_cast<int>(bullet.end.cols()), weft.rebound,
              weft.num_through);
  EXPECT_GT(std::abs(bullet.rebound), std::abs(weft.rebound));
}

TEST(ClothContact, MomentumGoesFromOneClothToTheOther) {
  for (const double speed : {0.5, 2.0}) {
    const Meeting meeting = meet(Contact::kWeft, speed, false);
    EXPECT_EQ(meeting.num_through, 0);
    // Equal masses: what rounding of positions of 0.1 m leaves in velocities, per step and node.
    const double rounding = 64 * static_cast<double>(std::numeric_limits<btScalar>::epsilon()) *
                            0.1 / kTimeStep / speed;
    EXPECT_NEAR(meeting.momentum, 0.0, rounding) << speed;
    EXPECT_LT(meeting.rebound, 0.0) << speed;  // both go on together
  }
}

TEST(ClothContact, RunsRepeatToTheBit) {
  EXPECT_EQ(meet(Contact::kWeft, 2.0, false).end, meet(Contact::kWeft, 2.0, false).end);
}

/// A strip whose right half lies 4 cm over its left one and is thrown at it; the share of its nodes
/// that end below.
double through_itself(bool with_itself, double speed) {
  ClothGrid grid;
  grid.nodes = {31, 7};
  grid.size = {0.9, 0.18};
  grid.total_mass = 0.05;
  const ClothMesh flat = make_cloth_grid(grid);
  SoftWorld world({.gravity = {0, 0, 0}});
  btSoftBody& body = world.add(make_cloth_body(world.info(), flat, linked()));
  if (with_itself) {
    world.solver().set_cloth_contact(body, {.with_itself = true, .self_thickness = kThickness});
  }
  int num_upper = 0;
  const auto is_upper = [&](int i) { return flat.rest_positions(0, i) > 0.06; };
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    const Vector3<double> x = flat.rest_positions.col(i);
    if (is_upper(i)) {
      ++num_upper;
      node.m_x.setValue(btScalar(0.06 - x.x() + 0.005), btScalar(0.04), btScalar(x.z() + 0.007));
      node.m_v.setValue(0, btScalar(-speed), 0);
    } else if (x.x() < -0.02) {
      node.m_im = 0;  // the lower half stays
    }
    node.m_q = node.m_x;
  }
  for (int step = 0; step < 64; ++step) world.step(kTimeStep);
  int num_through = 0;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btVector3& x = body.m_nodes[i].m_x;
    if (is_upper(i) && x.y() < 0 && x.x() < btScalar(-0.02)) ++num_through;
  }
  return static_cast<double>(num_through) / num_upper;
}

TEST(ClothContact, LayersOfAFoldDoNotPass) {
  EXPECT_EQ(through_itself(true, 3.0), 0.0);
  EXPECT_GT(through_itself(false, 3.0), 0.5);
}

TEST(ClothContact, AFlatClothMovesAsWithoutToTheBit) {
  const auto run = [](bool with_itself) {
    ClothMesh mesh = square(0.0, 0.0);
    mesh.pinned = {0, 12};
    SoftWorld world({});
    btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, linked()));
    if (with_itself) world.solver().set_cloth_contact(body, {.with_itself = true});
    world.solver().attach(body, mesh, {{"gravity", {}, {{"acceleration", {0, -9.81, 0}}}}});
    for (int step = 0; step < 64; ++step) world.step(kTimeStep);
    return positions(body);
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(ClothContact, SettingsOutOfTheirDomainAreRefused) {
  const ClothMesh mesh = square(0.0, 0.0);
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  EXPECT_THROW(world.solver().set_cloth_contact(body, {.self_thickness = 0}), InvalidArgument);
  EXPECT_THROW(world.solver().set_cloth_contact(body, {.margin = -1}), InvalidArgument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(world.solver().set_cloth_contact(body, {.friction = nan}), InvalidArgument);
}

TEST(FaceGrid, MissesNoFaceThatIsNear) {
  const ClothMesh mesh = square(0.0, 0.4);
  SoftWorld world({});
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  const btScalar reach = btScalar(0.02);
  FaceGrid grid;
  grid.build(body, reach);
  for (int i = 0; i < 500; ++i) {
    const btVector3 point(btScalar(0.25 * std::sin(12.9 * i)), btScalar(0.05 * std::sin(7.1 * i)),
                          btScalar(0.25 * std::sin(78.2 * i)));
    std::vector<int> found;
    grid.collect(point, found);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (int f = 0; f < body.m_faces.size(); ++f) {
      bool is_in = true;
      for (int axis = 0; axis < 3; ++axis) {
        const auto& n = body.m_faces[f].m_n;
        const auto [low, high] = std::minmax({n[0]->m_x[axis], n[1]->m_x[axis], n[2]->m_x[axis]});
        is_in = is_in && point[axis] >= low - reach && point[axis] <= high + reach;
      }
      if (is_in) EXPECT_TRUE(std::binary_search(found.begin(), found.end(), f));
    }
  }
}

}  // namespace
}  // namespace weft::bridge
