#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/validation/cases/analytic/bending/elastica.hpp>
#include <weft/validation/cases/analytic/bending/pinned_elastica.hpp>
#include <weft/validation/cases/analytic/statics/lattice_strip.hpp>

namespace weft::validation {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(Elastica, HeavyStripMeetsItsTable) {
  struct Row {
    double gamma, drop, reach, curvature;
  };
  for (const Row& row : {Row{0.01, .001250, .999999, .0050}, Row{1, .123471, .991246, .4969},
                         Row{10, .700200, .656354, 3.7422}, Row{100, .937524, .159223, 13.693},
                         Row{1e4, .994110, .014261, 141.004}}) {
    const HeavyElastica tip = solve_heavy_elastica(row.gamma);
    EXPECT_NEAR(tip.drop, row.drop, 1e-6) << row.gamma;
    EXPECT_NEAR(tip.reach, row.reach, 1e-6) << row.gamma;
    EXPECT_NEAR(tip.curvature, row.curvature, 1e-4 * std::max(1.0, row.curvature)) << row.gamma;
  }
}

TEST(Elastica, TipLoadMeetsItsTable) {
  struct Row {
    double load, angle, drop, shortening;
  };
  for (const Row& row : {Row{.5, .24453, .16214, .01592}, Row{2, .78175, .49346, .16064},
                         Row{10, 1.43029, .81061, .55500}}) {
    const HeavyElastica tip = solve_elastica({.tip_load = row.load});
    EXPECT_NEAR(tip.tip_angle, row.angle, 1e-5) << row.load;
    EXPECT_NEAR(tip.drop, row.drop, 1e-5) << row.load;
    EXPECT_NEAR(1 - tip.reach, row.shortening, 1e-5) << row.load;
  }
}

TEST(Elastica, ChordOfTheBendingTest) {
  EXPECT_NEAR(gamma_of_chord(41.5 * kDegree), 8.0042, 1e-4);
}

TEST(Elastica, TiltOfTheClampTurnsAStiffStrip) {
  const HeavyElastica tip = solve_elastica({.gamma = 1e-6, .tilt = 30 * kDegree});
  EXPECT_NEAR(tip.drop, 0.5, 1e-6);
  EXPECT_NEAR(tip.reach, std::sqrt(0.75), 1e-6);
}

TEST(Elastica, RefusesWhatItCannotSolve) {
  EXPECT_THROW((void)solve_elastica({.gamma = -1}), InvalidArgument);
  EXPECT_THROW((void)solve_elastica({}), InvalidArgument);
  EXPECT_THROW((void)solve_elastica({.gamma = 1, .tilt = 2}), InvalidArgument);
}

TEST(PinnedElastica, MeetsItsTable) {
  struct Row {
    double ratio, compression;
  };
  for (const Row& row : {Row{.1, .0470}, Row{.2, .1549}, Row{.3, .2715}, Row{.5, .4483}}) {
    EXPECT_NEAR(pinned_elastica_of_ratio(row.ratio).compression, row.compression, 5e-4)
        << row.ratio;
  }
  const PinnedElastica half = pinned_elastica_of_compression(.2);
  EXPECT_NEAR(half.force, 21.721, 1e-3);
  EXPECT_NEAR(half.ratio, .2378, 1e-4);
}

TEST(LatticeStrip, TakesTheNearestDirectionThatRepeats) {
  EXPECT_NEAR(nearest_direction(17).angle(), 16.7, 0.1);
  EXPECT_NEAR(nearest_direction(45).angle(), 45, 1e-12);
  EXPECT_NEAR(nearest_direction(0).angle(), 0, 1e-12);
  EXPECT_NEAR(nearest_direction(90).angle(), 90, 1e-12);
}

TEST(LatticeStrip, EndsAtItsLengthAndWeighsWhatItsAreaDoes) {
  const LatticeDirection direction = nearest_direction(30);
  const ClothMesh mesh = make_lattice_strip(direction, 20, 0.1, 0.2);
  EXPECT_NEAR(mesh.rest_positions.row(0).maxCoeff(), 0.1, 1e-12);
  EXPECT_FALSE(mesh.pinned.empty());
  // A node for every cell.
  const Vector3<double> edge =
      mesh.rest_positions.col(mesh.triangles(1, 0)) - mesh.rest_positions.col(mesh.triangles(0, 0));
  const Vector3<double> other =
      mesh.rest_positions.col(mesh.triangles(2, 0)) - mesh.rest_positions.col(mesh.triangles(0, 0));
  const double spacing = std::min(edge.norm(), other.norm());
  EXPECT_NEAR(spacing, 0.1 / 20, 1e-3 * spacing * 20);
  EXPECT_NEAR(mesh.masses.maxCoeff(), 0.2 * spacing * spacing, 1e-12);
}

}  // namespace
}  // namespace weft::validation
