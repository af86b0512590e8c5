#include <weft/scenes/recording/rounding.hpp>

#include <cmath>
#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/recording/trim.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::TemporaryFolder;
using samples::write_sample;
using testing::HasSubstr;

constexpr double kRoundingInterval = 1.0 / 60;  // [s]

TEST(Rounding, KeepsItsBoundsInBothPrecisions) {
  for (const auto precision : {StoredPrecision::kFloat32, StoredPrecision::kFloat64}) {
    const TemporaryFolder folder;
    const Scene scene = make_scene(20);
    write_sample(folder / "a", scene, precision, 8);
    const RecordingReader a(folder / "a");
    for (const double error : {1e-2, 1e-3, 1e-4, 1e-6}) {
      TrimRange range;
      range.rounding = rounding_bounds(error, kRoundingInterval);
      RecordingWriter writer(folder / std::to_string(error), scene, trimmed_provenance(a, range),
                             precision);
      copy_range(a, range, writer);
      writer.finish();
      const RecordingReader b(folder / std::to_string(error));
      double position = 0.0;
      double velocity = 0.0;
      for (int frame = 0; frame < 8; ++frame) {
        const SceneState exact = a.frame(frame);
        const SceneState rounded = b.frame(frame);
        for (std::size_t c = 0; c < exact.cloths.size(); ++c) {
          position = std::max(
              position,
              (exact.cloths[c].positions - rounded.cloths[c].positions).cwiseAbs().maxCoeff());
          velocity = std::max(
              velocity,
              (exact.cloths[c].velocities - rounded.cloths[c].velocities).cwiseAbs().maxCoeff());
        }
        EXPECT_EQ(exact.rigids[0].orientation.coeffs(), rounded.rigids[0].orientation.coeffs());
      }
      EXPECT_LE(position, error);
      EXPECT_LE(velocity, error / kRoundingInterval);
      // Not less than could be had: the step is a power of two. Velocities of this motion reach 1 m/s.
      if (error > 1e-5) {
        EXPECT_GE(position, 0.4 * error);
      }
      if (error < 1e-2) {
        EXPECT_GE(velocity, 0.4 * error);
      }
      EXPECT_THAT(b.provenance().at("rounded"), HasSubstr("positions by at most"));
      EXPECT_TRUE(b.finished());
    }
  }
}

TEST(Rounding, MakesRecordingsSmaller) {
  const TemporaryFolder folder;
  const Scene scene = make_scene(40);
  write_sample(folder / "a", scene, StoredPrecision::kFloat32, 20);
  const RecordingReader a(folder / "a");
  TrimRange range;
  range.rounding = rounding_bounds(1e-4, kRoundingInterval);
  RecordingWriter writer(folder / "b", scene, {}, StoredPrecision::kFloat32);
  copy_range(a, range, writer);
  writer.finish();
  EXPECT_LT(std::filesystem::file_size(folder / "b"),
            0.75 * std::filesystem::file_size(folder / "a"));
}

TEST(Rounding, LeavesWhatIsNotFinite) {
  SceneState state = make_state(make_scene(), 1, StoredPrecision::kFloat64);
  state.cloths[0].positions(0, 0) = std::numeric_limits<double>::quiet_NaN();
  state.cloths[0].positions(1, 0) = -std::numeric_limits<double>::infinity();
  round_state(state, rounding_bounds(1e-3, kRoundingInterval));
  EXPECT_TRUE(std::isnan(state.cloths[0].positions(0, 0)));
  EXPECT_EQ(state.cloths[0].positions(1, 0), -std::numeric_limits<double>::infinity());
}

TEST(Rounding, RefusesBoundsThatAreNone) {
  EXPECT_THROW((void)rounding_bounds(0.0, kRoundingInterval), InvalidArgument);
  EXPECT_THROW((void)rounding_bounds(-1.0, kRoundingInterval), InvalidArgument);
  EXPECT_THROW((void)rounding_bounds(NAN, kRoundingInterval), InvalidArgument);
  EXPECT_THROW((void)rounding_bounds(1e-3, 0.0), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
