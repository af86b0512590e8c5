#include <weft/fast_solver/newton/anderson_history.hpp>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

// x -> c x in three components of one node, with another c in each: two changes tell two of them, and what is left shrinks as fast
// as the last.
TEST(AndersonHistory, SolvesALinearIterationFasterThanItConverges) {
  constexpr int kRows = kNodeLine;
  const Eigen::Array3d shrinks(0.9, 0.8, 0.1);
  AndersonHistory<double> history;
  history.resize(kRows);
  NodeArrays<double> places = NodeArrays<double>::Zero(kRows, 3);
  NodeArrays<double> results = places;
  NodeArrays<double> last = places;
  places.row(5) = Eigen::RowVector3d(1, 1, 1);
  for (int round = 0; round < 8; ++round) {
    results.row(5) = places.row(5).array() * shrinks.transpose();
    history.next();
    const auto products = history.add({0, kRows}, places, results, last);
    history.added();
    last = results;
    places = results;
    if (history.count() > 0) history.combine({0, kRows}, history.weights(products), places);
  }
  EXPECT_LT(places.norm(), 1e-4);  // 0.45 without
}

TEST(AndersonHistory, ChangesNothingWhereNothingHasChanged) {
  AndersonHistory<float> history;
  history.resize(kNodeLine);
  const NodeArrays<float> places = NodeArrays<float>::Ones(kNodeLine, 3);
  for (int round = 0; round < 3; ++round) {
    history.next();
    const auto products = history.add({0, kNodeLine}, places, places, places);
    history.added();
    NodeArrays<float> combined = places;
    history.combine({0, kNodeLine}, history.weights(products), combined);
    EXPECT_EQ(combined, places);
  }
}

}  // namespace
}  // namespace weft::fast
