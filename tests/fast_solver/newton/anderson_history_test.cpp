#include <weft/fast_solver/newton/anderson_history.hpp>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

// x -> c x in three components of one node, with another c in each: two changes tell two of them, and what is left shrinks as fast
// as the last.
TEST(AndersonHistory, SolvesALinearIterationFasterThanItConverges) {
  constexpr int kRows = kNodesPerCacheLine;
  const Eigen::Array3d shrinks(0.9, 0.8, 0.1);
  AndersonHistory<double> history;
  history.resize(kRows);
  NodeArrays<double> positions = NodeArrays<double>::Zero(kRows, 3);
  NodeArrays<double> results = positions;
  NodeArrays<double> last = positions;
  positions.row(5) = Eigen::RowVector3d(1, 1, 1);
  for (int iteration = 0; iteration < 8; ++iteration) {
    results.row(5) = positions.row(5).array() * shrinks.transpose();
    history.next();
    const auto products = history.add({0, kRows}, positions, results, last);
    history.added();
    last = results;
    positions = results;
    if (history.count() > 0) history.combine({0, kRows}, history.weights(products), positions);
  }
  EXPECT_LT(positions.norm(), 1e-4);  // 0.45 without
}

TEST(AndersonHistory, ChangesNothingWhereNothingHasChanged) {
  AndersonHistory<float> history;
  history.resize(kNodesPerCacheLine);
  const NodeArrays<float> positions = NodeArrays<float>::Ones(kNodesPerCacheLine, 3);
  for (int iteration = 0; iteration < 3; ++iteration) {
    history.next();
    const auto products = history.add({0, kNodesPerCacheLine}, positions, positions, positions);
    history.added();
    NodeArrays<float> combined = positions;
    history.combine({0, kNodesPerCacheLine}, history.weights(products), combined);
    EXPECT_EQ(combined, positions);
  }
}

// One node that goes from place to place, three times; a history that restarts after something else, whatever its slots were
// last, makes of it what a new one does.
TEST(AndersonHistory, RestartsWithoutWhatItsSlotsHold) {
  constexpr int kRows = kNodesPerCacheLine;
  const auto run = [](AndersonHistory<double>& history, double scale, int iterations) {
    NodeArrays<double> positions = NodeArrays<double>::Zero(kRows, 3);
    NodeArrays<double> last = positions;
    positions.row(5) = scale * Eigen::RowVector3d(1, 2, 3);
    for (int iteration = 0; iteration < iterations; ++iteration) {
      NodeArrays<double> results = positions;
      results.row(5).array() *= Eigen::Array3d(0.9, 0.8, 0.1).transpose();
      history.next();
      const auto products = history.add({0, kRows}, positions, results, last);
      history.added();
      last = results;
      positions = results;
      if (history.count() > 0) history.combine({0, kRows}, history.weights(products), positions);
    }
    return positions;
  };
  for (int before = 1; before < 5; ++before) {
    AndersonHistory<double> fresh;
    fresh.resize(kRows);
    AndersonHistory<double> used;
    used.resize(kRows);
    (void)run(used, 100, before);
    used.forget();
    EXPECT_EQ(run(used, 1, 3), run(fresh, 1, 3)) << before << " iterations before";
  }
}

}  // namespace
}  // namespace weft::fast
