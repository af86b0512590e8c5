#pragma once

#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/core/types.hpp>

namespace weft::forces {

/// What the tests of the assemblies have in common.

template <class Scalar>
Matrix3X<Scalar> random_field(int num_nodes, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-0.25, 0.25);
  Matrix3X<Scalar> field(3, num_nodes);
  for (Scalar& value : field.reshaped()) value = static_cast<Scalar>(uniform(generator));
  return field;
}

/// count elements whose nodes are drawn at random.
template <class Elements>
Elements random_elements(int count, int num_nodes) {
  std::mt19937 generator(3);
  Elements elements(Elements::RowsAtCompileTime, count);
  for (int& node : elements.reshaped()) {
    node = static_cast<int>(generator() % static_cast<unsigned>(num_nodes));
  }
  return elements;
}

/// sum() must give the same matrix, bit for bit, on any number of threads.
template <class Sum>
void expect_same_bits_for_all_threads(const Sum& sum) {
  decltype(sum()) one;
  with_threads(1, [&] { one = sum(); });
  for (const int threads : {2, 3, 8}) {
    decltype(sum()) several;
    with_threads(threads, [&] { several = sum(); });
    EXPECT_EQ(std::memcmp(one.data(), several.data(),
                          static_cast<std::size_t>(one.size()) * sizeof(*one.data())),
              0)
        << threads << " threads";
  }
}

/// add(scratch, result) sums one field over a mesh of num_nodes and needs so many columns of scratch memory.
template <class Add>
void expect_wrong_sizes_are_refused(const Add& add, Eigen::Index scratch_columns, int num_nodes) {
  Matrix3X<double> scratch(3, scratch_columns);
  Matrix3X<double> result = Matrix3X<double>::Zero(3, num_nodes);
  EXPECT_NO_THROW(add(scratch, result));
  EXPECT_THROW(add(scratch.leftCols(1), result), InvalidArgument);
  EXPECT_THROW(add(scratch, result.leftCols(num_nodes - 1)), InvalidArgument);
  Eigen::MatrixXd tall(4, scratch_columns);
  EXPECT_THROW(add(tall.topRows(3), result), InvalidArgument);
}

}  // namespace weft::forces
