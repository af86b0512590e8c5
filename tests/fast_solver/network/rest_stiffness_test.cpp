#include <weft/fast_solver/network/rest_stiffness.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include <weft/custom_forces/law_set.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::fast {
namespace {

using forces::LawSpecification;

const LawSpecification kHinges{"hinge_torsion", {}, {{"rigidity", {0.01}}}};
const LawSpecification kLines{"torsion", {}, {{"stiffness", {3.0}}, {"side_ratio", {0.5}}}};

/// A grid whose cells are no squares, flat or bent about an axis that is none of the world's.
ClothMesh sheet(double curvature) {
  ClothGrid grid;
  grid.nodes = {6, 5};
  grid.size = {1.0, 1.3};
  grid.total_mass = 0.3;
  ClothMesh mesh = make_cloth_grid(grid);
  for (auto x : mesh.rest_positions.colwise()) {
    const double along = x.x() + 0.4 * x.z();
    x += Vector3<double>(0, 0.5 * curvature * along * along, 0);
  }
  return mesh;
}

using PairTraces = std::map<std::pair<int, int>, double>;

/// Traces of the blocks, from products with unit displacements of each node.
PairTraces traces_by_products(const ClothMesh& mesh, const std::vector<LawSpecification>& laws) {
  forces::LawSet<double> set;
  for (const auto& law : laws) set.add(forces::make_law<double>(law, mesh));
  const int n = mesh.num_nodes();
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, n);
  const forces::State<double> rest{mesh.rest_positions, still, mesh.masses, 0.0};
  PairTraces traces;
  for (int node = 0; node < n; ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      Matrix3X<double> displacements = Matrix3X<double>::Zero(3, n);
      displacements(axis, node) = 1;
      Matrix3X<double> product = Matrix3X<double>::Zero(3, n);
      set.add_stiffness_product(rest, displacements, product);
      for (int other = node + 1; other < n; ++other) traces[{node, other}] -= product(axis, other);
    }
  }
  return traces;
}

void expect_traces(const ClothMesh& mesh, const std::vector<LawSpecification>& laws) {
  PairTraces found;
  for (const MatrixPart& part : rest_stiffness(mesh, laws)) {
    EXPECT_LT(part.row, part.column);
    EXPECT_TRUE(found.insert({{part.row, part.column}, part.value}).second) << "a pair twice";
  }
  const PairTraces expected = traces_by_products(mesh, laws);
  double largest = 0;
  for (const auto& [pair, trace] : expected) largest = std::max(largest, std::abs(trace));
  ASSERT_GT(largest, 0);
  for (const auto& [pair, trace] : expected) {
    const auto entry = found.find(pair);
    EXPECT_NEAR(entry == found.end() ? 0 : entry->second, trace, 1e-11 * largest)
        << pair.first << ", " << pair.second;
  }
}

TEST(RestStiffness, IsThatOfProductsOnAFlatSheet) {
  expect_traces(sheet(0), {kHinges});
  expect_traces(sheet(0), {kLines});
  expect_traces(sheet(0), {kHinges, kLines});
}

TEST(RestStiffness, IsThatOfProductsOnABentSheet) {
  expect_traces(sheet(1.5), {kHinges});
  expect_traces(sheet(1.5), {kLines});
}

}  // namespace
}  // namespace weft::fast
