// Layers of cloth do not pass through each other, as an independent count of edges through triangles sees it.
#include <weft/bridge/contact/layer_impacts.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/contact/cloth_pairs.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/validation/metrics/distance/self_intersection.hpp>

namespace weft::bridge {
namespace {

constexpr double kSpacing = 0.02;    // [m] of nodes
constexpr double kThickness = 0.01;  // [m]

ClothMesh sheet(int nodes, const Vector3<double>& center, double turn = 0) {
  ClothGrid grid;
  grid.nodes = {nodes, nodes};
  grid.size = {kSpacing * (nodes - 1), kSpacing * (nodes - 1)};
  grid.total_mass = 1e-4 * nodes * nodes;
  grid.lumping = MassLumping::kUniform;
  grid.center = center;
  grid.u_axis = {std::cos(turn), 0, std::sin(turn)};
  grid.v_axis = {std::sin(turn), 0, -std::cos(turn)};
  return make_cloth_grid(grid);
}

/// Sheets, and ways of their nodes that a test gives them.
class Sheets {
 public:
  btSoftBody& add(const ClothMesh& mesh) {
    meshes_.push_back(mesh);
    btSoftBody& body = world_.add(make_cloth_body(world_.info(), mesh, {}));
    for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_q = body.m_nodes[i].m_x;
    bodies_.push_back(&body);
    contacts_.push_back(
        std::make_unique<ClothContact>(body, ClothContactSettings{.with_itself = true,
                                                                  .with_others = true,
                                                                  .self_thickness = kThickness,
                                                                  .margin = kThickness / 2}));
    return body;
  }
  /// way(start) [m] for every node.
  template <class Way>
  static void move(btSoftBody& body, Way way) {
    for (int i = 0; i < body.m_nodes.size(); ++i)
      body.m_nodes[i].m_x = body.m_nodes[i].m_q + way(body.m_nodes[i].m_q);
  }
  /// Each with itself and with all others.
  LayerImpacts::Outcome resolve() {
    LayerImpacts impacts;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      impacts.add({bodies_[b], contacts_[b].get()});
      for (std::size_t other = 0; other <= b; ++other) impacts.add_pair(b, other);
    }
    return impacts.resolve().front();
  }
  [[nodiscard]] int num_piercings() const {
    int count = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const Matrix3X<double> x = ends(b);
      count += static_cast<int>(validation::self_piercings(x, meshes_[b].triangles).size());
      for (std::size_t other = 0; other < b; ++other)
        count += validation::count_piercings(x, meshes_[b].triangles, ends(other),
                                             meshes_[other].triangles);
    }
    return count;
  }
  /// Sums of mass times way, and of mass times its square.
  [[nodiscard]] Vector3<double> momentum() const { return sum().head<3>(); }
  [[nodiscard]] double energy() const { return sum()[3]; }

  [[nodiscard]] Matrix3X<double> ends(std::size_t b) const {
    Matrix3X<btScalar> x;
    Matrix3X<btScalar> v;
    read_nodes(*bodies_[b], x, v);
    return x.cast<double>();
  }

 private:
  [[nodiscard]] Eigen::Vector4d sum() const {
    Eigen::Vector4d all = Eigen::Vector4d::Zero();
    for (const btSoftBody* body : bodies_) {
      for (int i = 0; i < body->m_nodes.size(); ++i) {
        const btSoftBody::Node& node = body->m_nodes[i];
        if (!(node.m_im > 0)) continue;
        const btVector3 way = node.m_x - node.m_q;
        const double mass = 1 / static_cast<double>(node.m_im);
        for (int k = 0; k < 3; ++k) all[k] += mass * static_cast<double>(way[k]);
        all[3] += mass * static_cast<double>(way.length2());
      }
    }
    return all;
  }

  SoftWorld world_{{.gravity = {0, 0, 0}}};
  std::vector<ClothMesh> meshes_;
  std::vector<btSoftBody*> bodies_;
  std::vector<std::unique_ptr<ClothContact>> contacts_;
};

constexpr auto kStay = [](const btVector3&) { return btVector3(0, 0, 0); };

// A sheet lies as a U, with layers so far apart that it is known not to meet itself, until another one drives its upper layer into the
// lower one in the same step.
TEST(LayerImpacts, KeepLayersApartThatAnotherSheetDrivesIntoEachOther) {
  constexpr double kGap = 0.24;  // [m]
  constexpr double kWay = 0.4;   // [m] of the other sheet
  const ClothContactSettings settings{
      .with_itself = true, .with_others = true, .self_thickness = 0.005, .margin = 0.0025};
  SoftWorld world{SoftWorldSettings{}};
  const auto grid_of = [](int across, int along, double mass) {
    ClothGrid grid;
    grid.nodes = {across, along};
    grid.size = {0.01 * (across - 1), 0.01 * (along - 1)};
    grid.total_mass = mass;
    return grid;
  };
  const ClothMesh folded = make_cloth_grid(grid_of(101, 17, 0.02));
  btSoftBody& body = world.add(make_cloth_body(world.info(), folded, {}));
  ClothContact contact(body, settings);
  const double radius = kGap / 2;
  const double straight = 0.5 - std::numbers::pi * radius / 2;  // of each layer
  for (int i = 0; i < folded.num_nodes(); ++i) {
    const double along = folded.rest_positions(0, i) + 0.5;
    const double angle = std::clamp((along - straight) / radius, 0.0, std::numbers::pi);
    const double back = std::max(0.0, along - straight - std::numbers::pi * radius);
    const double x = -std::min(along, straight) - radius * std::sin(angle) + back;
    btSoftBody::Node& node = body.m_nodes[i];
    node.m_x = node.m_q =
        to_bullet(Vector3<double>(x, radius * std::cos(angle), folded.rest_positions(2, i)));
  }
  ClothGrid grid = grid_of(15, 21, 0.5);
  grid.center = {-0.07, kGap / 2 + 0.02, 0.003};
  const ClothMesh falling = make_cloth_grid(grid);
  btSoftBody& other = world.add(make_cloth_body(world.info(), falling, {}));
  ClothContact other_contact(other, settings);
  for (int i = 0; i < other.m_nodes.size(); ++i) {
    other.m_nodes[i].m_q = other.m_nodes[i].m_x;
    other.m_nodes[i].m_x -= btVector3(0, btScalar(kWay), 0);
  }
  contact.begin_step();
  other_contact.begin_step();
  ASSERT_TRUE(contact.is_apart_from_itself(body));
  ClothPairs pairs;
  pairs.add_self(body, contact);
  pairs.add(body, contact, other, other_contact);
  int num_impacts = 0;
  pairs.keep_apart([&](const btSoftBody&, const LayerImpacts::Outcome& outcome) {
    num_impacts = outcome.num_impacts;
    EXPECT_TRUE(outcome.is_clear);
  });
  EXPECT_GT(num_impacts, 0);
  Matrix3X<btScalar> x;
  Matrix3X<btScalar> v;
  read_nodes(body, x, v);
  EXPECT_EQ(validation::self_piercings(x.cast<double>(), folded.triangles).size(), 0U);
}

TEST(LayerImpacts, HoldASheetThatWouldFlyThroughAnother) {
  for (const double way : {0.06, 0.2, 1.0, 3.0}) {
    Sheets sheets;
    Sheets::move(sheets.add(sheet(15, {0, 0, 0})), kStay);
    btSoftBody& above = sheets.add(sheet(9, {0.004, 0.05, 0.003}, 0.4));
    Sheets::move(above, [&](const btVector3&) { return btVector3(0, btScalar(-way), 0); });
    const Vector3<double> momentum = sheets.momentum();
    const double energy = sheets.energy();
    const LayerImpacts::Outcome outcome = sheets.resolve();
    EXPECT_TRUE(outcome.is_clear) << way;
    EXPECT_GT(outcome.num_impacts, 0) << way;
    EXPECT_EQ(sheets.resolve().num_impacts, 0) << way;
    EXPECT_EQ(sheets.num_piercings(), 0) << way;
    EXPECT_LT((sheets.momentum() - momentum).norm(), 1e-5 * momentum.norm()) << way;
    EXPECT_LE(sheets.energy(), energy) << way;
  }
}

// No node is over a face: strips cross at a right angle, and their long edges meet.
TEST(LayerImpacts, HoldEdgesThatWouldPassThroughEdges) {
  const auto strip = [](double height, bool is_along_x) {
    ClothGrid grid;
    grid.nodes = {2, 2};
    grid.size = {1, 0.01};
    grid.total_mass = 0.01;
    grid.center = {0, height, 0};
    grid.u_axis = is_along_x ? Vector3<double>(1, 0, 0) : Vector3<double>(0, 0, 1);
    grid.v_axis = is_along_x ? Vector3<double>(0, 0, -1) : Vector3<double>(1, 0, 0);
    return make_cloth_grid(grid);
  };
  Sheets sheets;
  Sheets::move(sheets.add(strip(0, true)), kStay);
  Sheets::move(sheets.add(strip(0.02, false)),
               [](const btVector3&) { return btVector3(0, btScalar(-0.05), 0); });
  EXPECT_TRUE(sheets.resolve().is_clear);
  EXPECT_GT(sheets.ends(1).row(1).mean(), sheets.ends(0).row(1).mean());
  EXPECT_EQ(sheets.num_piercings(), 0);
}

/// Ways that fold sheets wildly: waves of some nodes' length and noise, times a size [m].
auto random_way(unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  Eigen::Matrix3d waves;
  Vector3<double> phases;
  for (int i = 0; i < 9; ++i) waves(i) = 60 * number(random);
  for (int i = 0; i < 3; ++i) phases[i] = 3 * number(random);
  return [=](const btVector3& start) mutable {
    const Vector3<double> x(start.x(), start.y(), start.z());
    const Vector3<double> phase = waves * x + phases;
    btVector3 way;
    for (int k = 0; k < 3; ++k)
      way[k] = static_cast<btScalar>(size * (std::sin(phase[k]) + 0.3 * number(random)));
    return way;
  };
}

TEST(LayerImpacts, LeaveNoIntersectionOfSheetsThatCrumple) {
  int num_without = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    for (const double size : {0.01, 0.03, 0.1}) {
      Sheets sheets;
      for (int layer = 0; layer < 3; ++layer) {
        btSoftBody& body = sheets.add(sheet(11, {0, 0.012 * layer, 0}, 0.3 * layer));
        Sheets::move(body, random_way(3 * seed + static_cast<unsigned>(layer), size));
      }
      num_without += sheets.num_piercings();
      const Vector3<double> momentum = sheets.momentum();
      const double energy = sheets.energy();
      EXPECT_TRUE(sheets.resolve().is_clear) << "seed " << seed << " size " << size;
      EXPECT_EQ(sheets.num_piercings(), 0) << "seed " << seed << " size " << size;
      EXPECT_LE(sheets.energy(), 1.001 * energy) << "seed " << seed << " size " << size;
      EXPECT_LT((sheets.momentum() - momentum).norm(), 1e-5 * std::sqrt(energy * 0.0363));
    }
  }
  EXPECT_GT(num_without, 3000);  // else there was nothing to hold
}

TEST(LayerImpacts, LeaveWhatMeetsNothing) {
  Sheets sheets;
  Sheets::move(sheets.add(sheet(9, {0, 0, 0})), kStay);
  Sheets::move(sheets.add(sheet(9, {0, 0.05, 0})), [](const btVector3& start) {
    return btVector3(btScalar(0.3), btScalar(-0.03) * start.x(), 0);
  });
  const Matrix3X<double> before = sheets.ends(1);
  const LayerImpacts::Outcome outcome = sheets.resolve();
  EXPECT_TRUE(outcome.is_clear);
  EXPECT_EQ(outcome.num_impacts, 0);
  EXPECT_EQ(sheets.ends(1), before);
}

TEST(LayerImpacts, LeavePinsWhereTheyAreLed) {
  for (const double way : {0.06, 0.2, 1.0, 3.0}) {
    Sheets sheets;
    ClothMesh held = sheet(15, {0, 0, 0});
    for (int i = 0; i < held.num_nodes(); ++i) held.pinned.push_back(i);
    Sheets::move(sheets.add(held),
                 [&](const btVector3&) { return btVector3(0, btScalar(way), 0); });
    Sheets::move(sheets.add(sheet(9, {0.004, 0.05, 0.003}, 0.4)), kStay);
    const Matrix3X<double> led = sheets.ends(0);
    EXPECT_TRUE(sheets.resolve().is_clear) << way;
    EXPECT_EQ(sheets.ends(0), led) << way;
    EXPECT_GT(sheets.ends(1).row(1).minCoeff(), led.row(1).maxCoeff()) << way;
  }
}

TEST(LayerImpacts, GiveUpWhereANodeIsNowhereAndWhereAllIsNearAll) {
  Sheets sheets;
  btSoftBody& body = sheets.add(sheet(21, {0, 0, 0}));
  Sheets::move(body, kStay);
  body.m_nodes[7].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  EXPECT_FALSE(sheets.resolve().is_clear);
  int number = 0;  // each node goes far, one to this side and the next to that
  Sheets::move(body, [&](const btVector3&) {
    const btScalar far = ++number % 2 == 0 ? btScalar(1e4) : btScalar(-1e4);
    return btVector3(far, -far, far);
  });
  const Matrix3X<double> before = sheets.ends(0);
  EXPECT_FALSE(sheets.resolve().is_clear);
  EXPECT_EQ(sheets.ends(0), before);
}

// One pair of sheets does not depend on another one.
TEST(LayerImpacts, OfOthersAreHeldWhereANodeIsNowhere) {
  SoftWorld world({.gravity = {0, 0, 0}});
  std::vector<btSoftBody*> bodies;
  std::vector<std::unique_ptr<ClothContact>> contacts;
  LayerImpacts impacts;
  for (int b = 0; b < 4; ++b) {
    const Vector3<double> center(b / 2, 0.05 * (b % 2), 0);
    btSoftBody& body = world.add(make_cloth_body(world.info(), sheet(9, center, 0.2 * b), {}));
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      body.m_nodes[i].m_q = body.m_nodes[i].m_x;
      if (b % 2 == 1) body.m_nodes[i].m_x -= btVector3(0, btScalar(0.1), 0);
    }
    bodies.push_back(&body);
    contacts.push_back(std::make_unique<ClothContact>(
        body, ClothContactSettings{.with_others = true, .margin = kThickness / 2}));
    impacts.add({&body, contacts.back().get()});
  }
  bodies[0]->m_nodes[3].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  impacts.add_pair(0, 1);
  impacts.add_pair(2, 3);
  const std::vector<LayerImpacts::Outcome> outcomes = impacts.resolve();
  EXPECT_FALSE(outcomes[0].is_clear);
  EXPECT_FALSE(outcomes[1].is_clear);
  EXPECT_TRUE(outcomes[2].is_clear);
  EXPECT_GT(outcomes[3].num_impacts, 0);
  EXPECT_GT(bodies[3]->m_nodes[40].m_x.y(), bodies[2]->m_nodes[40].m_x.y());
}

// A light node between a pin and what moves the pin's edge is not thrown away.
TEST(LayerImpacts, ThrowNoNodeThatHardlyTakesPart) {
  ClothGrid grid;
  grid.nodes = {2, 2};
  grid.size = {1, 0.1};
  grid.total_mass = 0.01;
  ClothMesh mesh = make_cloth_grid(grid);
  mesh.pinned = {0, 2};
  Sheets sheets;
  Sheets::move(sheets.add(mesh), kStay);
  // It comes down beside the pins, at a five hundredth of the way to the free nodes.
  ClothMesh other = sheet(2, {0, 0.02, 0});
  other.rest_positions.row(0).array() += mesh.rest_positions(0, 0) + 0.002 + kSpacing / 2;
  for (int i = 0; i < other.num_nodes(); ++i) other.pinned.push_back(i);
  Sheets::move(sheets.add(other),
               [](const btVector3&) { return btVector3(0, btScalar(-0.03), 0); });
  (void)sheets.resolve();
  EXPECT_LT((sheets.ends(0) - mesh.rest_positions).colwise().norm().maxCoeff(), 0.1);
}

TEST(LayerImpacts, HaveTheSameBitsForAnyNumberOfThreads) {
  const auto run = [] {
    Sheets sheets;
    for (int layer = 0; layer < 3; ++layer) {
      btSoftBody& body = sheets.add(sheet(25, {0, 0.012 * layer, 0}, 0.3 * layer));
      Sheets::move(body, random_way(static_cast<unsigned>(layer), 0.05));
    }
    (void)sheets.resolve();
    return sheets.ends(1);
  };
  EXPECT_EQ(with_threads(1, run), with_threads(4, run));
}

/// Sheets of Weft's implicit springs that fall on a box, one over the other, in steps of a game.
struct Pile {
  explicit Pile(int num_sheets) {
    for (int s = 0; s < num_sheets; ++s) {
      const ClothMesh mesh = sheet(15, {0, 0.04 + 0.03 * s, 0}, 0.3 * s);
      btSoftBody& body =
          world.add(make_cloth_body(world.info(), mesh, {.collision_margin = 0.006}));
      (void)world.solver().attach_fast(body, mesh,
                                       {{"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
                                        {"tension", {}, {{"stiffness", {300.0}}}}});
      world.solver().set_cloth_contact(
          body,
          {.with_itself = true, .with_others = true, .self_thickness = 0.012, .margin = 0.006});
      meshes.push_back(mesh);
      bodies.push_back(&body);
    }
    auto shape =
        std::make_shared<btBoxShape>(btVector3(btScalar(0.06), btScalar(0.02), btScalar(0.06)));
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape.get());
    world.add(std::make_unique<btRigidBody>(info), std::move(shape));
  }
  [[nodiscard]] double kinetic_energy() const {
    double sum = 0;
    for (const btSoftBody* body : bodies) {
      for (int i = 0; i < body->m_nodes.size(); ++i)
        sum += 0.5e-4 * static_cast<double>(body->m_nodes[i].m_v.length2());
    }
    return sum;
  }
  [[nodiscard]] int num_piercings() const {
    int count = 0;
    std::vector<Matrix3X<double>> x;
    for (const btSoftBody* body : bodies) {
      Matrix3X<btScalar> places;
      Matrix3X<btScalar> v;
      read_nodes(*body, places, v);
      x.push_back(places.cast<double>());
    }
    for (std::size_t b = 0; b < x.size(); ++b) {
      count += static_cast<int>(validation::self_piercings(x[b], meshes[b].triangles).size());
      for (std::size_t other = 0; other < b; ++other)
        count += validation::count_piercings(x[b], meshes[b].triangles, x[other],
                                             meshes[other].triangles);
    }
    return count;
  }

  SoftWorld world{{.gravity = {0, -9.81, 0}}};
  std::vector<ClothMesh> meshes;
  std::vector<btSoftBody*> bodies;
};

// Without substeps and without this, five sheets threw each other about, 300 J from half a joule.
TEST(LayerImpacts, LetFiveSheetsLieOnABoxInStepsOfAGame) {
  Pile pile(5);
  // All that gravity could give them.
  const double most = 5 * 15 * 15 * 1e-4 * 9.81 * 0.4;
  for (int step = 0; step < 150; ++step) {
    pile.world.step(1.0 / 60);
    ASSERT_EQ(pile.num_piercings(), 0) << step;
    ASSERT_LT(pile.kinetic_energy(), most) << step;
  }
  EXPECT_LT(pile.kinetic_energy(), 0.02 * most);
}

}  // namespace
}  // namespace weft::bridge
