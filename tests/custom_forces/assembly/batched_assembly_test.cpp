#include <weft/custom_forces/assembly/batched_assembly.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <weft/custom_forces/assembly/arc_tangent.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/topology/hinges.hpp>

#include "tests/custom_forces/assembly/assembled_sums.hpp"

namespace weft::forces {
namespace {

constexpr int kHinges = 3000;
/// n eps scale of the sum at one node: at most 4 kHinges terms of size <= 1.
constexpr double kBatchedSumRoundoff = 4 * kHinges * std::numeric_limits<double>::epsilon();

/// As the law of bending has them: cells cut both ways.
Hinges grid_hinges(int columns, int rows) {
  ClothGrid grid;
  grid.nodes = {columns, rows};
  return bending_hinges(make_cloth_grid(grid));
}

/// Differs for every hinge and corner, so that a mix-up shows. Elements are numbered by place.
template <class Scalar>
Corners<Scalar, 4> parts_of(const BatchedAssembly<4>& assembly, Eigen::Index place,
                            const Corners<Scalar, 4>& x) {
  const auto hinge = static_cast<Scalar>(assembly.order()[static_cast<std::size_t>(place)]);
  const Scalar weight = Scalar(1) / (Scalar(1) + hinge);
  return {weight * x[1], x[0].dot(x[3]) * x[2], weight * x[3], x[1].cross(x[2])};
}

template <class Scalar>
Matrix3X<Scalar> sum(const BatchedAssembly<4>& assembly) {
  const Matrix3X<Scalar> field = random_field<Scalar>(assembly.num_nodes(), 1);
  // contents of the scratch memory do not matter
  Matrix3X<Scalar> scratch =
      Matrix3X<Scalar>::Constant(3, assembly.scratch_columns(1), Scalar(1e30));
  Matrix3X<Scalar> result = Matrix3X<Scalar>::Ones(3, assembly.num_nodes());
  assembly.add<Scalar>(
      [&](Eigen::Index place, const Corners<Scalar, 4>& x) {
        return parts_of<Scalar>(assembly, place, x);
      },
      scratch, result, field);
  return result;
}

Corners<double, 4> corners_of(const Matrix3X<double>& field, const Hinges& hinges, Eigen::Index h) {
  Corners<double, 4> x;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const Vector3<double> vector = field.col(hinges(static_cast<Eigen::Index>(corner), h));
    x[corner] = {vector.x(), vector.y(), vector.z()};
  }
  return x;
}

std::vector<Eigen::Index> places_of(const BatchedAssembly<4>& assembly) {
  std::vector<Eigen::Index> places(assembly.order().size());
  for (std::size_t place = 0; place < places.size(); ++place) {
    places[static_cast<std::size_t>(assembly.order()[place])] = static_cast<Eigen::Index>(place);
  }
  return places;
}

void expect_naive_sum(const Hinges& hinges, int num_nodes, int grain) {
  const BatchedAssembly<4> assembly(hinges, num_nodes, grain);
  const Matrix3X<double> field = random_field<double>(num_nodes, 1);
  const std::vector<Eigen::Index> places = places_of(assembly);
  Matrix3X<double> expected = Matrix3X<double>::Ones(3, num_nodes);
  for (Eigen::Index h = 0; h < hinges.cols(); ++h) {
    const Corners<double, 4> parts = parts_of<double>(assembly, places[static_cast<std::size_t>(h)],
                                                      corners_of(field, hinges, h));
    for (std::size_t corner = 0; corner < 4; ++corner) {
      expected.col(hinges(static_cast<Eigen::Index>(corner), h)) +=
          Vector3<double>(parts[corner].x, parts[corner].y, parts[corner].z);
    }
  }
  EXPECT_LE((sum<double>(assembly) - expected).lpNorm<Eigen::Infinity>(), kBatchedSumRoundoff)
      << "grain " << grain;
}

TEST(BatchedAssembly, EqualsTheNaiveSumForEveryGrain) {
  for (const int grain : {1, 2, 7, 64, 2048, kHinges, 10 * kHinges}) {
    expect_naive_sum(random_elements<Hinges>(kHinges, 300), 300, grain);
    expect_naive_sum(grid_hinges(19, 24), 19 * 24, grain);
  }
}

TEST(BatchedAssembly, CopesWithOneNodeOneElementAndNone) {
  expect_naive_sum(random_elements<Hinges>(10, 1), 1, 3);  // all corners on the same node
  expect_naive_sum(random_elements<Hinges>(1, 4), 4, 2048);
  expect_naive_sum(Hinges(4, 0), 5, 2048);
  expect_naive_sum(Hinges(4, 0), 0, 2048);
}

TEST(BatchedAssembly, MakesRunsOfAGrid) {
  const ElementRuns<4> runs(grid_hinges(50, 50), 2500, 2048);
  Eigen::Index num_in_runs = 0;
  runs.for_each_chunk<double>(
      [&](const ElementRunsView<4>& view, const double*) {
        for (const ElementRun* run = view.begin; run != view.end; ++run) {
          if (run->is_consecutive) num_in_runs += run->count;
        }
      },
      random_field<double>(2500, 1));
  EXPECT_GT(num_in_runs, 9 * runs.elements().cols() / 10);
}

TEST(BatchedAssembly, ThreadsChangeNoBit) {
  const BatchedAssembly<4> grid(grid_hinges(40, 40), 1600, 500);
  const BatchedAssembly<4> random(random_elements<Hinges>(kHinges, 300), 300, 100);
  for (const BatchedAssembly<4>* assembly : {&grid, &random}) {
    expect_same_bits_for_all_threads([&] { return sum<float>(*assembly); });
    expect_same_bits_for_all_threads([&] { return sum<double>(*assembly); });
  }
}

// Compiled twice, for the baseline processor and for AVX2: the bits must agree, with all that laws compute with.
template <class Scalar>
void expect_same_hinges_without_avx2() {
  const ElementRuns<4> runs(grid_hinges(20, 20), 400, 2048);
  const auto force = [](Eigen::Index place, const Corners<Scalar, 4>& x) -> Corners<Scalar, 4> {
    const PlainVector<Scalar> normal = x[0].cross(x[1]);
    const Scalar length = std::sqrt(normal.squared_norm() + Scalar(1e-3));
    const Scalar angle = arc_tangent(x[2].dot(normal), x[3].dot(x[0]));
    const Tangent<Scalar> moving =
        arc_tangent(Tangent<Scalar>(x[0].x, x[1].x), Tangent<Scalar>(x[2].y, x[3].z));
    const Scalar chosen = choose(angle > Scalar(1), moving.rate, static_cast<Scalar>(place));
    return {angle * x[0], Scalar(chosen / length) * x[1], moving.value * x[2], normal};
  };
  const auto value = [](Eigen::Index, const Corners<Scalar, 4>& x) { return x[0].dot(x[2]); };
  runs.for_each_chunk<Scalar>(
      [&](const ElementRunsView<4>& view, const Scalar* field) {
        const auto count = static_cast<std::size_t>(3 * view.num_slots);
        std::vector<Scalar> chosen(2 * count, Scalar(0));
        std::copy(field, field + count, chosen.begin() + static_cast<std::ptrdiff_t>(count));
        std::vector<Scalar> baseline = chosen;
        evaluate_elements<Scalar, 4, 1>(force, view, chosen.data());
        evaluate_elements_inline<Scalar, 4>(force, view, baseline.data(),
                                            std::make_index_sequence<1>{});
        EXPECT_EQ(chosen, baseline);
        PartialSums<double> wide = {};
        PartialSums<double> plain = {};
        sum_elements<Scalar, 4, double>(value, view, field, wide);
        sum_elements_inline<Scalar, 4, double>(value, view, field, plain);
        EXPECT_EQ(std::memcmp(wide, plain, sizeof wide), 0);
      },
      random_field<Scalar>(400, 1));
}

TEST(BatchedAssembly, VectorWidthChangesNoBit) {
  expect_same_hinges_without_avx2<float>();
  expect_same_hinges_without_avx2<double>();
}

// A sum in single precision, one after the other, would be off by a hundred times as much.
TEST(BatchedAssembly, AddsUpSinglePrecisionInDouble) {
  const BatchedAssembly<4> assembly(grid_hinges(150, 150), 150 * 150);
  const Matrix3X<float> field = Matrix3X<float>::Ones(3, 150 * 150);
  const float total = assembly.sum<float>(
      [](Eigen::Index, const Corners<float, 4>& x) { return 0.1F * x[0].x; }, field);
  const double expected = static_cast<double>(0.1F) * static_cast<double>(assembly.size());
  EXPECT_LE(std::abs(static_cast<double>(total) - expected),
            expected * std::numeric_limits<float>::epsilon());
}

TEST(BatchedAssembly, RefusesWrongSizesAndGapsInScratch) {
  const BatchedAssembly<4> assembly(grid_hinges(5, 5), 25);
  const Matrix3X<double> field = Matrix3X<double>::Zero(3, 25);
  const auto force = [](Eigen::Index, const Corners<double, 4>& x) { return x; };
  const auto add = [&](Matrix3XRef<double> scratch, Matrix3XRef<double> result) {
    assembly.add<double>(force, scratch, result, field);
  };
  expect_wrong_sizes_are_refused(add, assembly.scratch_columns(1), 25);
}

}  // namespace
}  // namespace weft::forces
