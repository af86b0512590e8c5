// Which leaves of a tree of faces need not be searched for contacts with each other.
#include <weft/bridge/contact/flat_patches.hpp>

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::bridge::flat_patches_test {
namespace {

constexpr int kNodes = 25;
constexpr double kSpacing = 0.02;  // [m]
constexpr btScalar kDistance = btScalar(0.018);

ClothMesh sheet() {
  ClothGrid grid;
  grid.nodes = {kNodes, kNodes};
  grid.size = {kSpacing * (kNodes - 1), kSpacing * (kNodes - 1)};
  grid.total_mass = 0.1;
  return make_cloth_grid(grid);
}

using Place = std::function<btVector3(const btVector3&)>;
const Place kStays = [](const btVector3& x) { return x; };

/// A sheet whose rest shape is flat.
class Sheet {
 public:
  explicit Sheet(const ClothMesh& mesh = sheet())
      : body_(world_.add(make_cloth_body(world_.info(), mesh, {}))) {
    move(kStays, kStays);
    tree_.refit(body_, btVector3(0, 0, 0));
    flat_.find_neighbors(body_, tree_, kDistance);
    for (int i = 0; i < body_.m_nodes.size(); ++i) rest_.push_back(body_.m_nodes[i].m_x);
  }
  /// Where a step begins and ends, from places at rest.
  void move(const Place& start, const Place& end) {
    for (int i = 0; i < body_.m_nodes.size(); ++i) {
      const btVector3 rest =
          rest_.empty() ? body_.m_nodes[i].m_x : rest_[static_cast<std::size_t>(i)];
      body_.m_nodes[i].m_q = start(rest);
      body_.m_nodes[i].m_x = end(rest);
    }
    flat_.refit(body_, tree_);
  }
  /// Pairs of leaves that are flat together.
  [[nodiscard]] int count() const {
    int sum = 0;
    std::vector<char> is_flat(tree_.num_leaves(), 0);
    for (std::size_t leaf = 0; leaf < tree_.num_leaves(); ++leaf) {
      flat_.mark(leaf, is_flat);
      for (const char one : is_flat) sum += one == FlatPatches::kFlat ? 1 : 0;
      flat_.unmark(leaf, is_flat);
      for (const char one : is_flat) EXPECT_EQ(one, 0);
    }
    return sum;
  }
  [[nodiscard]] int num_leaves() const { return static_cast<int>(tree_.num_leaves()); }
  FlatPatches& flat() { return flat_; }

 private:
  SoftWorld world_{{.gravity = {0, 0, 0}}};
  btSoftBody& body_;
  FaceTree tree_;
  FlatPatches flat_;
  std::vector<btVector3> rest_;
};

/// Folded along z, the right half turned up by an angle about a line through x.
Place folded(double angle, double x = 0) {
  return [=](const btVector3& at) {
    const double beyond = static_cast<double>(at.x()) - x;
    if (beyond <= 0) return at;
    return btVector3(static_cast<btScalar>(x + beyond * std::cos(angle)),
                     static_cast<btScalar>(beyond * std::sin(angle)), at.z());
  };
}

TEST(FlatPatches, AreAllNeighborsOfAFlatSheet) {
  Sheet one;
  one.move(kStays, kStays);
  // Itself, and inside of the sheet eight others.
  EXPECT_GT(one.count(), 6 * one.num_leaves());
  EXPECT_LE(one.count(), 12 * one.num_leaves());
  one.flat().forget();
  EXPECT_EQ(one.count(), 0);
}

TEST(FlatPatches, AreNotAcrossAFold) {
  Sheet one;
  one.move(kStays, kStays);
  const int all = one.count();
  one.move(folded(0.4), folded(0.4));
  EXPECT_EQ(one.count(), all);
  one.move(folded(1.2), folded(1.2));
  EXPECT_LT(one.count(), all - 8);
  EXPECT_GT(one.count(), all / 2);
  one.move(kStays, folded(1.2));  // only at the end of the step
  EXPECT_LT(one.count(), all - 8);
}

// Half a turn of all of it about an axis in its plane: at the start and at the end the sheet is flat, in between it is nothing.
TEST(FlatPatches, AreNotWhatCollapsesWithinAStep) {
  Sheet one;
  one.move(kStays, [](const btVector3& x) { return btVector3(-x.x(), x.y(), x.z()); });
  EXPECT_EQ(one.count(), 0);
}

// The sides of a slit are neighbors where it ends. Flat as they are, they may come over each other.
TEST(FlatPatches, AreNotBesideASlit) {
  ClothMesh mesh = sheet();
  const int middle = kNodes / 2;
  const auto old_nodes = mesh.num_nodes();
  // Nodes of a line from the rim to the middle of the sheet are there twice.
  std::vector<int> copy(static_cast<std::size_t>(old_nodes), -1);
  int num = old_nodes;
  for (int k = 0; k < middle; ++k) {
    const int node = middle + k * kNodes;
    copy[static_cast<std::size_t>(node)] = num++;
  }
  mesh.rest_positions.conservativeResize(3, num);
  mesh.masses.conservativeResize(num);
  for (int i = 0; i < old_nodes; ++i) {
    const int other = copy[static_cast<std::size_t>(i)];
    if (other < 0) continue;
    mesh.rest_positions.col(other) = mesh.rest_positions.col(i);
    mesh.masses[other] = mesh.masses[i] /= 2;
  }
  const double line = mesh.rest_positions(0, middle);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    double x = 0;
    for (int k = 0; k < 3; ++k) x += mesh.rest_positions(0, mesh.triangles(k, t)) / 3;
    for (int k = 0; k < 3 && x > line; ++k) {
      const int other = copy[static_cast<std::size_t>(mesh.triangles(k, t))];
      if (other >= 0) mesh.triangles(k, t) = other;
    }
  }
  mesh.edge_sets.clear();
  Sheet whole;
  Sheet slit(mesh);
  whole.move(kStays, kStays);
  slit.move(kStays, kStays);
  EXPECT_LT(slit.count(), whole.count() - 12);
}

// A shirt and its pocket may be one body: leaves hold faces of both.
TEST(FlatPatches, AreNotLayersOfOneBody) {
  const ClothMesh one = sheet();
  ClothMesh two = one;
  const int count = one.num_nodes();
  two.rest_positions.conservativeResize(3, 2 * count);
  two.masses.conservativeResize(2 * count);
  two.triangles.conservativeResize(3, 2 * one.triangles.cols());
  for (int i = 0; i < count; ++i) {
    two.rest_positions.col(count + i) = one.rest_positions.col(i) + Vector3<double>(0, 0.02, 0);
    two.masses[count + i] = one.masses[i];
  }
  two.triangles.rightCols(one.triangles.cols()) = one.triangles.array() + count;
  two.edge_sets.clear();
  Sheet layers(two);
  layers.move(kStays, kStays);
  EXPECT_EQ(layers.count(), 0);
  // Far enough apart for leaves of their own, and joined at a node in the middle.
  two.rest_positions.rightCols(count).row(1).array() += 1;
  Sheet apart(two);
  apart.move(kStays, kStays);
  const int middle = count / 2;
  two.triangles = (two.triangles.array() == count + middle).select(middle, two.triangles);
  Sheet joined(two);
  joined.move(kStays, kStays);
  EXPECT_GT(apart.count(), 2 * 6 * 16);
  EXPECT_LT(joined.count(), apart.count());
}

}  // namespace
}  // namespace weft::bridge::flat_patches_test
