#include <weft/custom_forces/assembly/element_assembly.hpp>

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace weft::forces {
namespace {

/// n eps scale of the sum at one node: at most kElements terms of size 1.
constexpr int kElements = 5000;
constexpr double kElementAssemblySumRoundoff = kElements * std::numeric_limits<double>::epsilon();

template <int kNodes>
typename ElementAssembly<kNodes>::Elements random_elements(int count, int num_nodes) {
  std::mt19937 generator(3);
  typename ElementAssembly<kNodes>::Elements elements(kNodes, count);
  for (int& node : elements.reshaped()) {
    node = static_cast<int>(generator() % static_cast<unsigned>(num_nodes));
  }
  return elements;
}

/// A contribution that differs for every element, corner and axis, of size <= 1.
Vector3<double> part(Eigen::Index e, int corner) {
  const auto x = static_cast<double>(e);
  return {1.0 / (1.0 + x), -0.5 * corner, x / kElements};
}

template <int kNodes>
void expect_naive_sum(int count, int num_nodes, int grain) {
  const auto elements = random_elements<kNodes>(count, num_nodes);
  Matrix3X<double> expected = Matrix3X<double>::Ones(3, num_nodes);
  for (Eigen::Index e = 0; e < elements.cols(); ++e) {
    for (int corner = 0; corner < kNodes; ++corner) {
      expected.col(elements(corner, e)) += part(e, corner);
    }
  }
  const ElementAssembly<kNodes> assembly(elements, num_nodes, grain);
  Matrix3X<double> scratch =
      Matrix3X<double>::Constant(3, assembly.scratch_columns(), 1e30);  // contents do not matter
  Matrix3X<double> result = Matrix3X<double>::Ones(3, num_nodes);
  const auto kernel = [](Eigen::Index e, std::array<Vector3<double>, kNodes>& parts) {
    for (int corner = 0; corner < kNodes; ++corner) {
      parts[static_cast<std::size_t>(corner)] = part(e, corner);
    }
  };
  assembly.template add<double>(kernel, scratch, result);
  EXPECT_LE((result - expected).lpNorm<Eigen::Infinity>(), kElementAssemblySumRoundoff)
      << "grain " << grain;
  EXPECT_EQ(assembly.num_nodes(), num_nodes);
  EXPECT_EQ(assembly.elements(), elements);
}

TEST(ElementAssembly, EqualsTheNaiveSumForEveryGrain) {
  for (const int grain : {1, 2, 7, 64, 2048, kElements, 10 * kElements}) {
    expect_naive_sum<2>(kElements, 300, grain);
    expect_naive_sum<3>(kElements, 300, grain);
    expect_naive_sum<4>(kElements, 300, grain);
  }
}

TEST(ElementAssembly, CopesWithOneElementAndOneNode) {
  expect_naive_sum<2>(1, 2, 2048);
  expect_naive_sum<2>(10, 1, 3);  // both corners on the same node
}

TEST(ElementAssembly, NoElementsAddNothing) {
  expect_naive_sum<2>(0, 5, 2048);
  expect_naive_sum<2>(0, 0, 2048);
}

TEST(ElementAssembly, ScratchHoldsOnlyTouchedNodes) {
  const Edges edges{{0, 2, 0}, {2, 4, 4}};
  EXPECT_EQ(ElementAssembly<2>(edges, 1000, 3).scratch_columns(), 3);
  EXPECT_EQ(ElementAssembly<2>(edges, 1000, 1).scratch_columns(), 6);
}

}  // namespace
}  // namespace weft::forces
