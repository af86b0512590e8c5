#include <weft/mesh/cutting/tear.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/cutting/tear_rule.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft {
namespace {

constexpr int kColumns = 6;

/// 6 x 5 nodes, 1 m x 0.8 m, so that cells are 0.2 m wide; node (i, j) is j * 6 + i.
ClothMesh sheet(GridStencil stencil = GridStencil::k24Neighbour) {
  ClothMesh mesh = make_cloth_grid(
      {.nodes = {kColumns, 5}, .size = {1.0, 0.8}, .stencil = stencil, .total_mass = 0.3});
  mesh.pinned = {0, 5};
  mesh.pinned_velocities = Matrix3X<double>::Zero(3, 2);
  mesh.pinned_velocities.col(1) << 1, 2, 3;
  mesh.node_sets.push_back({"seam", {2, 8, 14, 20, 26}});
  return mesh;
}

Edges edges(std::initializer_list<std::pair<int, int>> list) {
  Edges result(2, static_cast<Eigen::Index>(list.size()));
  Eigen::Index e = 0;
  for (const auto& [a, b] : list) result.col(e++) << a, b;
  return result;
}

const EdgeSet& set_of(const ClothMesh& mesh, std::string_view name) {
  for (const EdgeSet& set : mesh.edge_sets) {
    if (set.name == name) return set;
  }
  throw InvalidArgument("no such set");
}

std::set<std::pair<int, int>> pairs_of(const ClothMesh& mesh, std::string_view name) {
  std::set<std::pair<int, int>> pairs;
  const EdgeSet& set = set_of(mesh, name);
  for (Eigen::Index e = 0; e < set.edges.cols(); ++e) {
    EXPECT_LT(set.edges(0, e), set.edges(1, e));
    EXPECT_TRUE(pairs.emplace(set.edges(0, e), set.edges(1, e)).second) << name;
  }
  return pairs;
}

/// What must hold for a mesh after any number of cuts.
void expect_consistent(const ClothMesh& mesh) {
  const int n = mesh.num_nodes();
  ASSERT_EQ(mesh.masses.size(), n);
  EXPECT_GT(mesh.masses.minCoeff(), 0.0);
  const auto expect_nodes = [n](const auto& elements) {
    if (elements.size() == 0) return;
    EXPECT_GE(elements.minCoeff(), 0);
    EXPECT_LT(elements.maxCoeff(), n);
  };
  expect_nodes(mesh.triangles);
  expect_nodes(mesh.crossed_triangles);
  for (const EdgeSet& set : mesh.edge_sets) {
    expect_nodes(set.edges);
    (void)pairs_of(mesh, set.name);
  }
  for (const LineSet& set : mesh.line_sets) expect_nodes(set.triples);
  EXPECT_TRUE(std::is_sorted(mesh.pinned.begin(), mesh.pinned.end()));
  // One fan around each node: rings() throws for a bow tie.
  std::vector<int> all(static_cast<std::size_t>(n));
  for (int node = 0; node < n; ++node) all[static_cast<std::size_t>(node)] = node;
  EXPECT_NO_THROW((void)rings(mesh.triangles, all));
  EXPECT_NO_THROW((void)hinges_of_triangles(mesh.triangles));
  EXPECT_NO_THROW((void)hinges_of_triangles(mesh.crossed_triangles));
}

TEST(Tear, OneEdgeInsideStaysShut) {
  const Tear tear = cut_along(sheet(), edges({{8, 14}}));
  EXPECT_FALSE(tear.any());
  EXPECT_EQ(tear.mesh.num_nodes(), 30);
}

TEST(Tear, TwoEdgesInARowOpenAtTheNodeBetween) {
  const ClothMesh mesh = sheet();
  const Tear tear = cut_along(mesh, edges({{8, 14}, {14, 20}}));
  ASSERT_EQ(tear.origins, std::vector<int>{14});
  expect_consistent(tear.mesh);
  EXPECT_EQ(tear.mesh.num_nodes(), 31);
  EXPECT_EQ(tear.mesh.triangles.cols(), mesh.triangles.cols());
  EXPECT_EQ(tear.mesh.rest_positions.col(30), mesh.rest_positions.col(14));
}

TEST(Tear, ACutFromRimToRimMakesTwoPieces) {
  const ClothMesh mesh = sheet();
  const Tear tear = cut_along(mesh, edges({{2, 8}, {8, 14}, {14, 20}, {20, 26}}));
  EXPECT_EQ(tear.origins, (std::vector<int>{2, 8, 14, 20, 26}));
  expect_consistent(tear.mesh);
  // By hand: 5 rows of 5 horizontal and 6 columns of 4 vertical threads, the cut column twice.
  EXPECT_EQ(set_of(tear.mesh, "stretch").edges.cols(), 25 + 24 + 4);
  EXPECT_EQ(set_of(tear.mesh, "shear").edges.cols(), 40);  // no diagonal crosses a column
  const auto is_left = [&](int node) { return tear.mesh.rest_positions(0, node) < -0.1 + 1e-9; };
  for (const EdgeSet& set : tear.mesh.edge_sets) {
    for (Eigen::Index e = 0; e < set.edges.cols(); ++e) {
      const double a = tear.mesh.rest_positions(0, set.edges(0, e));
      const double b = tear.mesh.rest_positions(0, set.edges(1, e));
      // The cut is at x = -0.1: no spring has ends on either side of it.
      EXPECT_GE((a + 0.1) * (b + 0.1), -1e-12) << set.name;
    }
  }
  EXPECT_TRUE(is_left(0));
  EXPECT_EQ(tear.mesh.crossed_triangles.cols(), 40);
}

TEST(Tear, BothSidesHaveASpringAlongTheCut) {
  const Tear tear = cut_along(sheet(), edges({{8, 14}, {14, 20}}));
  const auto stretch = pairs_of(tear.mesh, "stretch");
  for (const auto& pair : {std::pair(8, 14), {8, 30}, {14, 20}, {20, 30}}) {
    EXPECT_TRUE(stretch.contains(pair)) << pair.first << ' ' << pair.second;
  }
}

TEST(Tear, SpringsThatTheCutCrossesVanish) {
  const ClothMesh mesh = sheet();
  const Tear tear = cut_along(mesh, edges({{8, 14}, {14, 20}}));
  const auto before = pairs_of(mesh, "bend");
  const auto after = pairs_of(tear.mesh, "bend");
  ASSERT_TRUE(before.contains({13, 15}));  // (1, 2) to (3, 2), over node 14
  EXPECT_FALSE(after.contains({13, 15}));
  ASSERT_TRUE(before.contains({7, 15}));  // knight's move over the open edge 8 - 14
  EXPECT_FALSE(after.contains({7, 15}));
  EXPECT_TRUE(after.contains({7, 9}));  // over the tip at node 8, which holds
}

TEST(Tear, MassesSumToTheBitAndGoByArea) {
  const ClothMesh mesh = sheet();
  const Tear half = cut_along(mesh, edges({{8, 14}, {14, 20}}));
  EXPECT_EQ(half.mesh.masses[14] + half.mesh.masses[30], mesh.masses[14]);
  // Shares are multiples of 2^-26 of the mass.
  EXPECT_NEAR(half.mesh.masses[30] / mesh.masses[14], 0.5, 3e-8);
  // A quarter of the triangles around node 14 comes off: cut along two edges at right angles.
  const Tear quarter = cut_along(mesh, edges({{8, 14}, {14, 15}}));
  ASSERT_EQ(quarter.origins.size(), 1U);
  EXPECT_EQ(quarter.mesh.masses[14] + quarter.mesh.masses[30], mesh.masses[14]);
  const double ratio = quarter.mesh.masses[30] / mesh.masses[14];
  EXPECT_NEAR(std::min(ratio, 1 - ratio), 0.25, 3e-8);
}

TEST(Tear, ACopyOfAPinnedNodeIsPinnedAndMovesAlike) {
  ClothMesh mesh = sheet();
  mesh.pinned = {2, 5};
  const Tear tear = cut_along(mesh, edges({{2, 8}}));
  ASSERT_EQ(tear.origins, std::vector<int>{2});
  EXPECT_EQ(tear.mesh.pinned, (std::vector<int>{2, 5, 30}));
  EXPECT_EQ(tear.mesh.pinned_velocities.cols(), 3);
  EXPECT_EQ(tear.mesh.pinned_velocity(2), mesh.pinned_velocity(0));
  EXPECT_EQ(tear.mesh.node_sets[0].nodes.back(), 30);
}

TEST(Tear, AConnectionHoldsWithinAPieceOnly) {
  ClothMesh mesh = sheet();
  connect(mesh, "ties", 13, {12, 17});
  const Tear half = cut_along(mesh, edges({{2, 8}, {8, 14}}));
  EXPECT_EQ(half.mesh.connection_sets[0].connections.cols(), 2);
  const Tear whole = cut_along(mesh, edges({{2, 8}, {8, 14}, {14, 20}, {20, 26}}));
  EXPECT_EQ(whole.mesh.connection_sets[0].connections, edges({{13, 12}}));
}

TEST(Tear, ACellWithACutDiagonalIsNoLongerCutBothWays) {
  const ClothMesh mesh = sheet();
  // Cells (0, 0) and (1, 1): their diagonals 0 - 7 and 7 - 14 open node 7.
  const Tear tear = cut_along(mesh, edges({{0, 7}, {7, 14}}));
  EXPECT_EQ(tear.origins, (std::vector<int>{0, 7}));
  EXPECT_EQ(tear.mesh.crossed_triangles.cols(), mesh.crossed_triangles.cols() - 4);
  EXPECT_FALSE(pairs_of(tear.mesh, "shear").contains({1, 6}));  // across the open diagonal
  expect_consistent(tear.mesh);
}

TEST(Tear, ABowTieComesApart) {
  ClothMesh mesh;
  mesh.rest_positions.resize(3, 5);
  mesh.rest_positions << 0, -1, -1, 1, 1, 0, -1, 1, -1, 1, 0, 0, 0, 0, 0;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 2, 3, 1, 4;
  mesh.masses = VectorX<double>::Constant(5, 0.1);
  const Tear tear = cut_along(mesh, Edges(2, 0));
  EXPECT_EQ(tear.origins, std::vector<int>{0});
  expect_consistent(tear.mesh);
}

TEST(Tear, EveryEdgeCutLeavesSingleTrianglesThatSumToTheMass) {
  const ClothMesh mesh = sheet();
  const Tear tear = cut_along(mesh, edges_of_triangles(mesh.triangles));
  expect_consistent(tear.mesh);
  EXPECT_EQ(tear.mesh.num_nodes(), 3 * 40);
  EXPECT_EQ(hinges_of_triangles(tear.mesh.triangles).cols(), 0);
  std::map<int, double> sums;
  for (int node = 0; node < tear.mesh.num_nodes(); ++node) {
    const int origin = node < 30 ? node : tear.origins[static_cast<std::size_t>(node) - 30];
    sums[origin] += tear.mesh.masses[node];
  }
  for (int node = 0; node < 30; ++node) EXPECT_EQ(sums[node], mesh.masses[node]) << node;
}

TEST(Tear, RefusesWhatTheMeshDoesNotHave) {
  EXPECT_THROW((void)cut_along(sheet(), edges({{0, 30}})), InvalidArgument);
  ClothMesh book = sheet();
  book.triangles.conservativeResize(3, 41);
  book.triangles.col(40) << 0, 1, 20;
  book.triangles.conservativeResize(3, 42);
  book.triangles.col(41) << 0, 1, 26;
  EXPECT_THROW((void)cut_along(book, Edges(2, 0)), InvalidArgument);
}

/// Energy [J] of all springs of a mesh, 30 N/m each: of those without a twin, and of the second of
/// two that come from one (a cut ran along it).
struct SpringEnergy {
  double single = 0.0;
  double twins = 0.0;
};

SpringEnergy spring_energy(const ClothMesh& mesh, const Matrix3X<double>& positions,
                           const std::vector<int>& root) {
  SpringEnergy energy;
  for (const EdgeSet& set : mesh.edge_sets) {
    std::set<std::pair<int, int>> seen;
    const VectorX<double> rest = edge_lengths(mesh.rest_positions, set.edges);
    const VectorX<double> now = edge_lengths(positions, set.edges);
    for (Eigen::Index e = 0; e < set.edges.cols(); ++e) {
      const auto pair = std::minmax({root[static_cast<std::size_t>(set.edges(0, e))],
                                     root[static_cast<std::size_t>(set.edges(1, e))]});
      const double stored = 15.0 * (now[e] - rest[e]) * (now[e] - rest[e]);
      (seen.insert(pair).second ? energy.single : energy.twins) += stored;
    }
  }
  return energy;
}

/// Cuts at random, again and again.
TEST(Tear, FuzzedCutsKeepMassAndShapeAndOnlyTwinsAddEnergy) {
  int num_splits = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    ClothMesh mesh =
        seed % 4 == 0
            ? make_icosphere({.radius = 0.5, .frequency = 3, .total_mass = 0.2})
            : sheet(seed % 2 == 0 ? GridStencil::k12Neighbour : GridStencil::k24Neighbour);
    const VectorX<double> first_masses = mesh.masses;
    std::vector<int> root(static_cast<std::size_t>(mesh.num_nodes()));
    for (std::size_t i = 0; i < root.size(); ++i) root[i] = static_cast<int>(i);
    Matrix3X<double> positions = mesh.rest_positions;
    for (double& x : positions.reshaped()) {
      x = 1.2 * x + 0.05 * (static_cast<double>(random() % 2001) / 1000.0 - 1.0);
    }
    for (int round = 0; round < 12; ++round) {
      const Edges all = edges_of_triangles(mesh.triangles);
      std::vector<int> chosen;
      for (Eigen::Index e = 0; e < all.cols(); ++e) {
        if (random() % 6 == 0) chosen.insert(chosen.end(), {all(0, e), all(1, e)});
      }
      const SpringEnergy before = spring_energy(mesh, positions, root);
      const Tear tear =
          cut_along(mesh, Eigen::Map<const Edges>(chosen.data(), 2, std::ssize(chosen) / 2));
      ASSERT_EQ(tear.mesh.num_nodes(), mesh.num_nodes() + std::ssize(tear.origins));
      const Eigen::Index old = positions.cols();
      positions.conservativeResize(3, tear.mesh.num_nodes());
      for (std::size_t k = 0; k < tear.origins.size(); ++k) {
        positions.col(old + static_cast<Eigen::Index>(k)) = positions.col(tear.origins[k]);
        root.push_back(root[static_cast<std::size_t>(tear.origins[k])]);
      }
      num_splits += static_cast<int>(tear.origins.size());
      mesh = tear.mesh;
      expect_consistent(mesh);
      // Round-off of sums over some thousand springs.
      EXPECT_LE(spring_energy(mesh, positions, root).single, before.single * (1 + 1e-12)) << seed;
    }
    VectorX<double> sums = VectorX<double>::Zero(first_masses.size());
    for (int node = 0; node < mesh.num_nodes(); ++node) {
      sums[root[static_cast<std::size_t>(node)]] += mesh.masses[node];
    }
    EXPECT_EQ(sums, first_masses) << seed;  // exact, in any order
  }
  EXPECT_GT(num_splits, 5000);
}

TEST(TearRule, TearsNothingBelowTheLimit) {
  const ClothMesh mesh = sheet();
  Matrix3X<double> positions = mesh.rest_positions;
  positions.row(0) *= 1.49;
  EXPECT_EQ(edges_to_tear(mesh, positions, {.strain = 0.5}).cols(), 0);
  positions.row(0) *= 1.02;
  EXPECT_GT(edges_to_tear(mesh, positions, {.strain = 0.5}).cols(), 0);
}

TEST(TearRule, ACrackRunsAcrossWhatPulls) {
  const ClothMesh mesh = sheet();
  Matrix3X<double> positions = mesh.rest_positions;
  positions.row(0) *= 1.6;
  const Edges cut = edges_to_tear(mesh, positions, {.max_splits = 1});
  ASSERT_GE(cut.cols(), 1);
  for (Eigen::Index e = 0; e < cut.cols(); ++e) {
    EXPECT_EQ(mesh.rest_positions(0, cut(0, e)), mesh.rest_positions(0, cut(1, e)));
  }
  EXPECT_TRUE(cut_along(mesh, cut).any());
}

TEST(TearRule, AWeakRegionGivesWayFirst) {
  const ClothMesh mesh = sheet();
  Matrix3X<double> positions = mesh.rest_positions;
  positions.row(0) *= 1.3;
  const Edges cut =
      edges_to_tear(mesh, positions, {.strain = 0.5, .max_splits = 9, .weak = {{"seam", 0.2}}});
  const Tear tear = cut_along(mesh, cut);
  ASSERT_TRUE(tear.any());
  for (const int origin : tear.origins) EXPECT_EQ(origin % kColumns, 2);
}

TEST(TearRule, NoMoreNodesGiveWayThanAllowed) {
  const ClothMesh mesh = sheet();
  const Matrix3X<double> positions = 3.0 * mesh.rest_positions;
  EXPECT_EQ(cut_along(mesh, edges_to_tear(mesh, positions, {.max_splits = 1})).origins.size(), 1U);
  for (int most = 2; most < 5; ++most) {
    const Tear tear = cut_along(mesh, edges_to_tear(mesh, positions, {.max_splits = most}));
    EXPECT_GE(std::ssize(tear.origins), most);
    EXPECT_LE(std::ssize(tear.origins), 2 * most);  // and those between two of them
  }
}

TEST(TearRule, NothingPullsBehindATornEnd) {
  const Tear tear = cut_along(sheet(), edges({{2, 8}, {8, 14}, {14, 20}, {20, 26}}));
  Matrix3X<double> positions = tear.mesh.rest_positions;
  // Only the threads that end at the new rim are long.
  for (const int node : {2, 8, 14, 20, 26}) positions(0, node) += 0.5;
  const Edges cut = edges_to_tear(tear.mesh, positions, {.strain = 0.5, .max_splits = 9});
  EXPECT_EQ(cut.cols(), 0);
}

TEST(TearRule, NeverTearsWhatIsNotFinite) {
  const ClothMesh mesh = sheet();
  Matrix3X<double> positions = 3.0 * mesh.rest_positions;
  positions(1, 7) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(edges_to_tear(mesh, positions, {}).cols(), 0);
}

TEST(TearRule, RefusesValuesOutOfTheirDomain) {
  const ClothMesh mesh = sheet();
  const auto refused = [&](const TearRule& rule) {
    EXPECT_THROW((void)edges_to_tear(mesh, mesh.rest_positions, rule), InvalidArgument);
  };
  refused({.strain = 0.0});
  refused({.strain = std::numeric_limits<double>::quiet_NaN()});
  refused({.variation = 1.0});
  refused({.max_splits = 0});
  refused({.edge_set = "weft"});
  refused({.weak = {{"hem", 0.2}}});
  EXPECT_THROW((void)edges_to_tear(mesh, Matrix3X<double>::Zero(3, 3), {}), InvalidArgument);
}

TEST(Blade, CutsAlongAColumnFromTheRimToItsEnd) {
  const ClothMesh mesh = sheet();
  const Vector3<double> normal =
      Vector3<double>(1, 0, 0).cross(mesh.rest_positions.col(6) - mesh.rest_positions.col(0));
  const Vector3<double> start = mesh.rest_positions.col(2);
  const Vector3<double> end = mesh.rest_positions.col(14);
  const Edges cut = edges_under({start, end, normal}, mesh, mesh.rest_positions);
  EXPECT_EQ(cut, edges({{2, 8}, {8, 14}}));
  EXPECT_EQ(cut_along(mesh, cut).origins, (std::vector<int>{2, 8}));
  EXPECT_THROW((void)edges_under({start, start, normal}, mesh, mesh.rest_positions),
               InvalidArgument);
}

TEST(Blade, CutsWhatItMeetsOnly) {
  const ClothMesh mesh = sheet();
  const Vector3<double> above(0, 1, 0);  // the sheet lies in the plane y = 0
  const Blade high{above + Vector3<double>(-0.1, 0, 1), above + Vector3<double>(-0.1, 0, -1),
                   0.5 * above};
  EXPECT_EQ(edges_under(high, mesh, mesh.rest_positions).cols(), 0);
  Blade deep = high;
  deep.depth *= 3;
  EXPECT_EQ(edges_under(deep, mesh, mesh.rest_positions).cols(), 4);
}

}  // namespace
}  // namespace weft
