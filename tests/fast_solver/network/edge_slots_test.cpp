#include <set>
#include <utility>

#include <gtest/gtest.h>

#include <weft/fast_solver/network/edge_slots.hpp>
#include <weft/fast_solver/network/network_forces.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "tests/fast_solver/node_arrays.hpp"

namespace weft::fast {
namespace {

Edges grid_edges(int n) {
  ClothGrid grid;
  grid.nodes = {n, n};
  const ClothMesh mesh = make_cloth_grid(grid);
  return mesh.edges_of({"stretch", "shear", "bend"});
}

/// Edges between nodes that are far from each other in their order, some nodes with many.
Edges wild_edges(int num_nodes) {
  std::set<std::pair<int, int>> pairs;
  for (int i = 0; i < num_nodes; ++i) {
    const int a = (i * 37 + 11) % num_nodes;
    const int b = (i * i + 3 * i) % num_nodes;
    if (a != b) pairs.emplace(std::min(a, b), std::max(a, b));
    if (i > 0) pairs.emplace(0, i);
  }
  Edges edges(2, static_cast<Eigen::Index>(pairs.size()));
  Eigen::Index e = 0;
  for (const auto& [a, b] : pairs) edges.col(e++) << a, b;
  return edges;
}

SpringNetwork network_of(const Edges& edges) {
  const Eigen::Index m = edges.cols();
  SpringNetwork network;
  network.edges = edges;
  network.rest_lengths = VectorX<double>::LinSpaced(m, 0.5, 1.5);
  network.stiffness = VectorX<double>::LinSpaced(m, 10, 90);
  network.compressed_stiffness = 0.5 * network.stiffness;
  network.damping = VectorX<double>::LinSpaced(m, 0.1, 0.3);
  network.bending = VectorX<double>::LinSpaced(m, 0.0, 2.0);
  return network;
}

TEST(EdgeSlots, HoldEachEdgeOnceAtBothEnds) {
  for (const Edges& edges : {grid_edges(9), wild_edges(67)}) {
    const EdgeSlots slots = make_edge_slots(edges, edges.maxCoeff() + 1);
    std::multiset<std::pair<int, int>> ends;
    for (int block = 0; block < slots.num_blocks(); ++block) {
      const SlotRange& range = slots.blocks[static_cast<std::size_t>(block)];
      for (int s = range.begin; s < range.end; ++s) {
        const EdgeSlot& slot = slots.slots[static_cast<std::size_t>(s)];
        EXPECT_EQ(slot.is_scattered, s >= range.rows_end);
        for (int lane = 0; lane < kNodeBlock; ++lane) {
          const auto place = static_cast<std::size_t>(s * kNodeBlock + lane);
          if (slots.edges[place] < 0) continue;
          const int node = block * kNodeBlock + lane;
          if (!slot.is_scattered) {
            EXPECT_EQ(slots.others[place], node + slot.offset);
          }
          ends.emplace(node, slots.others[place]);
        }
      }
    }
    std::multiset<std::pair<int, int>> expected;
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      expected.emplace(edges(0, e), edges(1, e));
      expected.emplace(edges(1, e), edges(0, e));
    }
    EXPECT_EQ(ends, expected);
  }
}

TEST(EdgeSlots, KeepAGridsNeighborsInARow) {
  const EdgeSlots slots = make_edge_slots(grid_edges(50), 2500);
  int num_scattered = 0;
  for (const EdgeSlot& slot : slots.slots) num_scattered += slot.is_scattered ? 1 : 0;
  EXPECT_LT(num_scattered, slots.num_slots() / 10);
}

// Each network against sums edge by edge, in double precision.
TEST(NetworkForces, AreThoseOfEachEdgeInAnyLayout) {
  for (const Edges& edges : {grid_edges(9), wild_edges(67)}) {
    const int n = edges.maxCoeff() + 1;
    const SpringNetwork network = network_of(edges);
    const double h = 0.01;
    const Matrix3X<double> q = Matrix3X<double>::Random(3, n);
    const Matrix3X<double> x = q + 0.1 * Matrix3X<double>::Random(3, n);
    Matrix3X<double> expected = Matrix3X<double>::Zero(3, n);
    double energy = 0;
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      const Vector3<double> d = x.col(edges(1, e)) - x.col(edges(0, e));
      const Vector3<double> before = q.col(edges(1, e)) - q.col(edges(0, e));
      const double extension = d.norm() - network.rest_lengths[e];
      const double k = extension < 0 ? network.compressed_stiffness[e] : network.stiffness[e];
      const double longer = d.norm() - before.norm();
      const double c = network.damping[e] / h;
      // Bending is in the matrix only.
      const Vector3<double> force = (k * extension + c * longer) * d.normalized();
      expected.col(edges(0, e)) += force;
      expected.col(edges(1, e)) -= force;
      energy += 0.5 * (k * extension * extension + c * longer * longer);
    }
    NetworkForces<double> forces(network, n);
    begin_step(forces, q, h);
    const Matrix3X<double> result = forces_at(forces, x);
    // The least length of a spring, a millionth, changes its length by 5e-13 of it.
    EXPECT_LT((result - expected).norm(), 1e-11 * expected.norm());
    EXPECT_NEAR(forces.potential(forces.all_nodes(), arrays_of(x)), energy, 1e-11 * energy);
  }
}

}  // namespace
}  // namespace weft::fast
