#include <weft/validation/recordings/recording_difference.hpp>

#include <limits>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/validation/metrics/distance/vertex_distance.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::validation {
namespace {

using scenes::Scene;
using scenes::SceneState;
using scenes::StoredPrecision;
using scenes::samples::make_scene;
using scenes::samples::make_state;
using scenes::samples::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kNumFrames = 6;

/// Distances are sums of a few squares of numbers below 10 m [m].
constexpr double kRoundOff = 1e-14;

using Change = std::function<void(int frame, SceneState& state)>;

/// The sample in double precision, with a change in each frame.
void write(const std::filesystem::path& path, const Change& change = {},
           const Scene& scene = make_scene(), int num_frames = kNumFrames) {
  scenes::RecordingWriter writer(path, scene, {}, StoredPrecision::kFloat64);
  for (int frame = 0; frame < num_frames; ++frame) {
    SceneState state = make_state(scene, frame, StoredPrecision::kFloat64);
    if (change) change(frame, state);
    writer.add_frame(state);
  }
  writer.finish();
}

RecordingDifference compare(const std::filesystem::path& a, const std::filesystem::path& b) {
  return compare_recordings(scenes::RecordingReader(a), scenes::RecordingReader(b));
}

/// The recording of a change against the unchanged one.
RecordingDifference difference_by(const Change& change) {
  const TemporaryFolder folder;
  write(folder / "a");
  write(folder / "b", change);
  return compare(folder / "a", folder / "b");
}

Scene scene_that_can_tear() {
  Scene scene = make_scene();
  scene.cloths[0].tear.emplace();
  scene.cloths[0].tear->rule.strain = 0.5;
  return scene;
}

/// From this frame on the first cloth has a node more, which one triangle has in place of its first.
void tear(SceneState& state, const Scene& scene, int triangle,
          std::shared_ptr<const scenes::ClothTopology>& topology) {
  scenes::ClothState& cloth = state.cloths[0];
  const Eigen::Index nodes = cloth.positions.cols();
  if (!topology) {
    scenes::ClothTopology torn{scenes::make_mesh(scene.cloths[0]).triangles, {}};
    torn.origins = {torn.triangles(0, triangle)};
    torn.triangles(0, triangle) = static_cast<int>(nodes);
    topology = std::make_shared<scenes::ClothTopology>(std::move(torn));
  }
  cloth.topology = topology;
  cloth.positions.conservativeResize(3, nodes + 1);
  cloth.velocities.conservativeResize(3, nodes + 1);
  cloth.positions.col(nodes) = cloth.positions.col(topology->origins[0]);
  cloth.velocities.col(nodes) = cloth.velocities.col(topology->origins[0]);
}

TEST(RecordingDifference, TheSameFramesAreEqual) {
  const RecordingDifference difference = difference_by({});
  EXPECT_TRUE(difference.is_equal());
  EXPECT_EQ(difference.num_common, kNumFrames);
  EXPECT_FALSE(difference.first);
  ASSERT_EQ(difference.bodies.size(), 3U);
  for (const BodyDifference& body : difference.bodies) {
    EXPECT_EQ(body.num_times, kNumFrames);
    EXPECT_EQ(body.largest, 0.0);
    EXPECT_EQ(body.largest_angle, 0.0);
    EXPECT_EQ(body.note, "");
  }
}

TEST(RecordingDifference, SaysWhichFrameBodyQuantityAndNodeDifferFirst) {
  const auto first_of = [](const Change& change) { return difference_by(change).first.value(); };
  const FirstDifference velocity = first_of([](int frame, SceneState& state) {
    if (frame >= 3) state.cloths[1].velocities(2, 7) += 1e-15;
    if (frame >= 4) state.cloths[0].positions(0, 0) += 1.0;
  });
  EXPECT_EQ(velocity.frame_a, 3);
  EXPECT_EQ(velocity.frame_b, 3);
  EXPECT_EQ(velocity.time, 3 / 60.0);
  EXPECT_EQ(velocity.body, "flag");
  EXPECT_EQ(velocity.quantity, "velocity");
  EXPECT_EQ(velocity.node, 7);
  const FirstDifference zero = first_of([](int frame, SceneState& state) {
    if (frame == 2) state.rigids[0].velocity[1] = -0.0;  // equal as a number
  });
  EXPECT_EQ(zero.frame_a, 2);
  EXPECT_EQ(zero.body, "ball");
  EXPECT_EQ(zero.quantity, "velocity");
  EXPECT_FALSE(zero.node);
  const FirstDifference time =
      first_of([](int frame, SceneState& state) { state.time += frame == 1 ? 1e-9 : 0.0; });
  EXPECT_EQ(time.frame_a, 1);
  EXPECT_EQ(time.body, "");
  EXPECT_EQ(time.quantity, "time");
}

TEST(RecordingDifference, ADistanceIsThatOfTheWorstTime) {
  const RecordingDifference difference = difference_by([](int frame, SceneState& state) {
    if (frame == 2) state.cloths[1].positions.row(1).array() += 0.3;
    if (frame == 4) state.cloths[1].positions.row(0).array() += 0.4;
  });
  const BodyDifference& flag = difference.bodies[1];
  EXPECT_EQ(flag.name, "flag");
  EXPECT_TRUE(flag.is_cloth);
  EXPECT_NEAR(flag.largest, 0.4, kRoundOff);
  EXPECT_NEAR(flag.rms, 0.4, kRoundOff);
  EXPECT_EQ(flag.frame_a, 4);
  EXPECT_EQ(flag.time, 4 / 60.0);
  EXPECT_NEAR(flag.rms_all, std::sqrt((0.3 * 0.3 + 0.4 * 0.4) / kNumFrames), kRoundOff);
  EXPECT_EQ(difference.bodies[0].largest, 0.0);
  EXPECT_EQ(difference.farthest(), &flag);
}

TEST(RecordingDifference, OneNodeCountsByItsArea) {
  const RecordingDifference difference = difference_by([](int frame, SceneState& state) {
    if (frame == 1) state.cloths[0].positions(2, 12) += 0.1;  // the middle of 5 x 5 nodes
  });
  EXPECT_NEAR(difference.bodies[0].largest, 0.1, kRoundOff);
  EXPECT_EQ(difference.bodies[0].node, 12);
  const double share = node_weights(scenes::make_mesh(make_scene().cloths[0]))[12];
  EXPECT_GT(share, 1.5 / 25);  // a node inside has more cloth than one at the rim
  EXPECT_NEAR(difference.bodies[0].rms, 0.1 * std::sqrt(share), kRoundOff);
}

TEST(RecordingDifference, ARigidBodyMovesAndTurns) {
  const RecordingDifference difference = difference_by([](int frame, SceneState& state) {
    if (frame != 5) return;
    state.rigids[0].position[2] += 0.25;
    state.rigids[0].orientation =
        Eigen::AngleAxisd(0.125, Vector3<double>(0, 1, 0)) * state.rigids[0].orientation;
  });
  const BodyDifference& ball = difference.bodies[2];
  EXPECT_EQ(ball.name, "ball");
  EXPECT_FALSE(ball.is_cloth);
  EXPECT_NEAR(ball.largest, 0.25, kRoundOff);
  EXPECT_EQ(ball.frame_a, 5);
  EXPECT_NEAR(ball.largest_angle, 0.125, 1e-12);
}

TEST(RecordingDifference, FewerFramesAreDifferentAndEqualAtCommonTimes) {
  const TemporaryFolder folder;
  write(folder / "a");
  write(folder / "b", {}, make_scene(), kNumFrames - 2);
  const RecordingDifference difference = compare(folder / "a", folder / "b");
  EXPECT_FALSE(difference.is_equal());
  EXPECT_FALSE(difference.first);
  EXPECT_EQ(difference.num_common, kNumFrames - 2);
}

TEST(RecordingDifference, PrecisionAndBlowUpCount) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  const auto write_still = [&](const char* name, StoredPrecision precision, bool blows_up) {
    scenes::RecordingWriter writer(folder / name, scene, {}, precision);
    SceneState state = make_state(scene, 0, StoredPrecision::kFloat32);
    writer.add_frame(state);
    if (blows_up) writer.set_blow_up(scenes::samples::kBlowUp);
    writer.finish();
  };
  write_still("single", StoredPrecision::kFloat32, false);
  write_still("double", StoredPrecision::kFloat64, false);
  write_still("blown", StoredPrecision::kFloat64, true);
  const RecordingDifference precision = compare(folder / "single", folder / "double");
  EXPECT_FALSE(precision.first);  // the numbers are those of single precision in both
  EXPECT_FALSE(precision.is_same_precision);
  EXPECT_FALSE(precision.is_equal());
  const RecordingDifference blow_up = compare(folder / "double", folder / "blown");
  EXPECT_FALSE(blow_up.first);
  EXPECT_FALSE(blow_up.is_same_blow_up);
  EXPECT_FALSE(blow_up.is_equal());
  EXPECT_TRUE(compare(folder / "blown", folder / "blown").is_equal());
}

TEST(RecordingDifference, BodiesAreFoundByNameAndKind) {
  const TemporaryFolder folder;
  Scene other = make_scene();
  std::swap(other.cloths[0], other.cloths[1]);
  other.colliders[0].name = "head";
  write(folder / "a");
  write(folder / "b", {}, other);
  const RecordingDifference difference = compare(folder / "a", folder / "b");
  ASSERT_EQ(difference.bodies.size(), 2U);
  EXPECT_EQ(difference.bodies[0].name, "towel");
  EXPECT_EQ(difference.bodies[0].largest, 0.0);
  EXPECT_EQ(difference.bodies[1].largest, 0.0);
  EXPECT_THAT(difference.only_in_a, ElementsAre("ball"));
  EXPECT_THAT(difference.only_in_b, ElementsAre("head"));
  EXPECT_FALSE(difference.is_equal());
}

TEST(RecordingDifference, AnotherMeshHasNoDistance) {
  const TemporaryFolder folder;
  write(folder / "a");
  write(folder / "b", {}, make_scene(4));
  const RecordingDifference difference = compare(folder / "a", folder / "b");
  EXPECT_EQ(difference.first.value().quantity, "number of nodes");
  EXPECT_EQ(difference.bodies[0].num_times, 0);
  EXPECT_EQ(difference.bodies[0].note, "has 25 and 16 nodes");
  EXPECT_EQ(difference.bodies[2].num_times, kNumFrames);
  EXPECT_EQ(difference.farthest(), &difference.bodies[2]);
}

TEST(RecordingDifference, ValuesThatAreNotFiniteHaveNoDistanceAndTheirBitsCount) {
  const Change blow_up = [](int frame, SceneState& state) {
    if (frame == 3) state.cloths[0].positions(0, 4) = std::numeric_limits<double>::quiet_NaN();
    if (frame == 4) state.cloths[0].positions.row(0).array() += 0.5;
  };
  const RecordingDifference difference = difference_by(blow_up);
  EXPECT_EQ(difference.first.value().frame_a, 3);
  EXPECT_EQ(difference.first->node, 4);
  const BodyDifference& towel = difference.bodies[0];
  EXPECT_EQ(towel.num_times, kNumFrames - 1);
  EXPECT_THAT(towel.note, HasSubstr("is not finite at t = 0.05 s, node 4"));
  EXPECT_NEAR(towel.largest, 0.5, kRoundOff);
  const TemporaryFolder folder;
  write(folder / "a", blow_up);
  write(folder / "b", blow_up);
  EXPECT_TRUE(compare(folder / "a", folder / "b").is_equal());
}

TEST(RecordingDifference, ClothThatTearsAlikeKeepsItsDistance) {
  const TemporaryFolder folder;
  const Scene scene = scene_that_can_tear();
  std::shared_ptr<const scenes::ClothTopology> topology;
  const auto tears_at_frame_2 = [&](int frame, SceneState& state) {
    if (frame >= 2) tear(state, scene, 6, topology);
  };
  write(folder / "a", tears_at_frame_2, scene);
  write(
      folder / "b",
      [&](int frame, SceneState& state) {
        tears_at_frame_2(frame, state);
        if (frame == 3) state.cloths[0].positions(1, 25) += 0.2;  // the new node
      },
      scene);
  const RecordingDifference difference = compare(folder / "a", folder / "b");
  EXPECT_EQ(difference.bodies[0].num_times, kNumFrames);
  EXPECT_NEAR(difference.bodies[0].largest, 0.2, kRoundOff);
  EXPECT_EQ(difference.bodies[0].node, 25);
  EXPECT_EQ(difference.bodies[0].note, "");
}

TEST(RecordingDifference, ClothThatTearsInAnotherWayIsComparedUntilThen) {
  const TemporaryFolder folder;
  const Scene scene = scene_that_can_tear();
  for (const int triangle : {6, 9}) {
    std::shared_ptr<const scenes::ClothTopology> topology;
    write(
        folder / std::to_string(triangle),
        [&](int frame, SceneState& state) {
          if (frame >= 3) tear(state, scene, triangle, topology);
        },
        scene);
  }
  const RecordingDifference difference = compare(folder / "6", folder / "9");
  EXPECT_EQ(difference.first.value().quantity, "topology");
  EXPECT_EQ(difference.first->frame_a, 3);
  EXPECT_EQ(difference.bodies[0].num_times, 3);
  EXPECT_EQ(difference.bodies[0].note, "has torn in another way from t = 0.05 s on");
}

}  // namespace
}  // namespace weft::validation
