#include <weft/custom_forces/assembly/edge_assembly.hpp>

#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <weft/mesh/cloth_grid.hpp>

#include "tests/custom_forces/assembly/assembled_sums.hpp"

namespace weft::forces {
namespace {

constexpr int kEdges = 5000;
/// n eps scale of the sum at one node: at most kEdges terms of size <= 1.
constexpr double kEdgeAssemblySumRoundoff = kEdges * std::numeric_limits<double>::epsilon();

Edges grid_edges(int columns, int rows) {
  ClothGrid grid;
  grid.nodes = {columns, rows};
  return make_cloth_grid(grid).edges_of({"stretch", "shear", "bend"});
}

/// Differs for every edge, so that a mix-up of places and edges shows.
template <class Scalar>
auto force_of(const EdgeAssembly& assembly) {
  return [&assembly](Eigen::Index place, const PlainVector<Scalar>& a,
                     const PlainVector<Scalar>& b) -> PlainVector<Scalar> {
    const auto edge = static_cast<Scalar>(assembly.order()[static_cast<std::size_t>(place)]);
    return (Scalar(1) / (Scalar(1) + edge)) * a + b.dot(a) * b;
  };
}

template <class Scalar>
Matrix3X<Scalar> sum(const EdgeAssembly& assembly) {
  const Matrix3X<Scalar> a = random_field<Scalar>(assembly.num_nodes(), 1);
  const Matrix3X<Scalar> b = random_field<Scalar>(assembly.num_nodes(), 2);
  // contents of the scratch memory do not matter
  Matrix3X<Scalar> scratch =
      Matrix3X<Scalar>::Constant(3, assembly.scratch_columns(2), Scalar(1e30));
  Matrix3X<Scalar> result = Matrix3X<Scalar>::Ones(3, assembly.num_nodes());
  assembly.add_pairs<Scalar>(force_of<Scalar>(assembly), scratch, result, a, b);
  return result;
}

void expect_naive_sum(const Edges& edges, int num_nodes, int grain) {
  const EdgeAssembly assembly(edges, num_nodes, grain);
  const Matrix3X<double> a = random_field<double>(num_nodes, 1);
  const Matrix3X<double> b = random_field<double>(num_nodes, 2);
  Matrix3X<double> expected = Matrix3X<double>::Ones(3, num_nodes);
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const Vector3<double> da = a.col(edges(1, e)) - a.col(edges(0, e));
    const Vector3<double> db = b.col(edges(1, e)) - b.col(edges(0, e));
    const Vector3<double> force = da / (1.0 + static_cast<double>(e)) + db.dot(da) * db;
    expected.col(edges(0, e)) += force;
    expected.col(edges(1, e)) -= force;
  }
  EXPECT_LE((sum<double>(assembly) - expected).lpNorm<Eigen::Infinity>(), kEdgeAssemblySumRoundoff)
      << "grain " << grain;
}

TEST(EdgeAssembly, EqualsTheNaiveSumForEveryGrain) {
  for (const int grain : {1, 2, 7, 64, 2048, kEdges, 10 * kEdges}) {
    expect_naive_sum(random_elements<Edges>(kEdges, 300), 300, grain);
    expect_naive_sum(grid_edges(19, 24), 19 * 24, grain);
  }
}

TEST(EdgeAssembly, CopesWithLoopsOneEdgeAndNone) {
  expect_naive_sum(random_elements<Edges>(10, 1), 1, 3);  // both ends on the same node
  expect_naive_sum(random_elements<Edges>(1, 2), 2, 2048);
  expect_naive_sum(Edges(2, 0), 5, 2048);
  expect_naive_sum(Edges(2, 0), 0, 2048);
}

TEST(EdgeAssembly, ThreadsChangeNoBit) {
  const EdgeAssembly grid(grid_edges(40, 40), 1600, 500);
  const EdgeAssembly random(random_elements<Edges>(kEdges, 300), 300, 100);
  for (const EdgeAssembly* assembly : {&grid, &random}) {
    expect_same_bits_for_all_threads([&] { return sum<float>(*assembly); });
    expect_same_bits_for_all_threads([&] { return sum<double>(*assembly); });
  }
}

// Compiled twice, for the baseline processor and for AVX2: the bits must agree.
template <class Scalar>
void expect_same_bits_without_avx2() {
  constexpr int kSlots = 200;
  std::vector<int> first(150);
  std::vector<int> second(150);
  for (std::size_t i = 0; i < first.size(); ++i) {
    first[i] = static_cast<int>(i < 64 ? i : (37 * i) % kSlots);
    second[i] = static_cast<int>(i < 64 ? i + 9 : (53 * i + 1) % kSlots);
  }
  const ElementRun runs[] = {{0, 64, true}, {64, 50, false}, {114, 36, false}};
  const ElementRunsView<2> view{runs, runs + 3, {first.data(), second.data()}, kSlots};
  const auto force = [](Eigen::Index place, const PlainVector<Scalar>& d) -> PlainVector<Scalar> {
    const Scalar length = std::sqrt(d.squared_norm() + Scalar(0.01));
    return Scalar((length - Scalar(0.001) * static_cast<Scalar>(place)) / length) * d;
  };
  Matrix3X<Scalar> chosen = random_field<Scalar>(2 * kSlots, 5);
  Matrix3X<Scalar> baseline = chosen;
  evaluate_runs<Scalar, 1>(force, view, chosen.data());
  evaluate_runs_inline(force, view, baseline.data(), std::make_index_sequence<1>{});
  EXPECT_EQ(std::memcmp(chosen.data(), baseline.data(),
                        static_cast<std::size_t>(chosen.size()) * sizeof(Scalar)),
            0);
}

TEST(EdgeAssembly, VectorWidthChangesNoBit) {
  expect_same_bits_without_avx2<float>();
  expect_same_bits_without_avx2<double>();
}

TEST(EdgeAssembly, RefusesWrongSizesAndGapsInScratch) {
  const EdgeAssembly assembly(grid_edges(5, 5), 25);
  const Matrix3X<double> field = Matrix3X<double>::Zero(3, 25);
  const auto force = [](Eigen::Index, const PlainVector<double>& d) { return d; };
  const auto add = [&](Matrix3XRef<double> scratch, Matrix3XRef<double> result) {
    assembly.add_pairs<double>(force, scratch, result, field);
  };
  expect_wrong_sizes_are_refused(add, assembly.scratch_columns(1), 25);
}

}  // namespace
}  // namespace weft::forces
