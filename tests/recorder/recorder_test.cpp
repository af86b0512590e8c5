#include <weft/recorder/recorder.hpp>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/recording/own_loop.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "tests/recorder/small_world.hpp"
#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::recorder {
namespace {

using scenes::RecordingReader;
using scenes::SceneState;
using scenes::samples::same_bits;
using scenes::samples::TemporaryFolder;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kStep = 1.0 / 120.0;   // [s]
constexpr double kFrames = 1.0 / 60.0;  // [s]

/// A patch that falls on a ball that falls on the ground.
struct RecorderTest : testing::Test {
  RecorderTest() {
    cloth = &world.add_patch(9, 2.0);
    cloth->setMass(0, 0);
    ball = &world.add(std::make_unique<btSphereShape>(btScalar(0.4)), 3.0, at(0.1, 1.3, 0));
    ball->setAngularVelocity(btVector3(1, 2, 3));
    ground = &world.add(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0.25)), 0,
                        at(0, 0, 0));
  }
  void add_all(Recorder& recorder) const {
    recorder.add(*cloth, "cape");
    recorder.add(*ball, "ball");
    recorder.add(*ground, "ground");
  }
  /// What Bullet has now, read here by itself.
  [[nodiscard]] SceneState state_now(double time) const {
    SceneState state;
    state.time = time;
    const int nodes = cloth->m_nodes.size();
    scenes::ClothState cape{"cape", Matrix3X<double>(3, nodes), Matrix3X<double>(3, nodes)};
    for (int i = 0; i < nodes; ++i) {
      for (int k = 0; k < 3; ++k) {
        cape.positions(k, i) = static_cast<double>(cloth->m_nodes[i].m_x[k]);
        cape.velocities(k, i) = static_cast<double>(cloth->m_nodes[i].m_v[k]);
      }
    }
    state.cloths.push_back(std::move(cape));
    return state;
  }

  TemporaryFolder folder;
  std::filesystem::path path = folder / "own.weftrec";
  SmallWorld world;
  btSoftBody* cloth = nullptr;
  btRigidBody* ball = nullptr;
  btRigidBody* ground = nullptr;
  RecorderOptions options{.name = "own_world", .frame_interval = kFrames};
};

void expect_equal(const btRigidBody& body, const scenes::RigidState& state) {
  const btTransform& place = body.getWorldTransform();
  const btQuaternion turn = place.getRotation();
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(state.position[k], static_cast<double>(place.getOrigin()[k]));
    EXPECT_EQ(state.velocity[k], static_cast<double>(body.getLinearVelocity()[k]));
    EXPECT_EQ(state.angular_velocity[k], static_cast<double>(body.getAngularVelocity()[k]));
    EXPECT_EQ(state.orientation.coeffs()[k], static_cast<double>(turn[k]));
  }
  EXPECT_EQ(state.orientation.w(), static_cast<double>(turn.w()));
}

TEST_F(RecorderTest, ReadsBackBitForBit) {
  Recorder recorder(path, options);
  add_all(recorder);
  std::vector<SceneState> expected;
  scenes::RigidState last_ball;
  for (int step = 0; step <= 60; ++step) {
    if (step > 0) world.step(kStep);
    const double time = step * kStep;
    if (recorder.record(time)) expected.push_back(state_now(time));
  }
  ASSERT_EQ(expected.size(), 31u);
  EXPECT_EQ(recorder.num_frames(), 31);
  const std::string hash = recorder.finish();

  const RecordingReader reader(path);
  EXPECT_TRUE(reader.finished());
  EXPECT_EQ(reader.content_hash(), hash);
  EXPECT_EQ(recorder.finish(), hash);
  ASSERT_EQ(reader.num_frames(), 31);
  for (int frame = 0; frame < 31; ++frame) {
    SceneState read = reader.frame(frame);
    if (frame == 30) expect_equal(*ball, read.rigids[0]);
    read.rigids.clear();
    EXPECT_TRUE(same_bits(read, expected[static_cast<std::size_t>(frame)])) << "frame " << frame;
  }
  EXPECT_GT((expected.back().cloths[0].positions - expected.front().cloths[0].positions).norm(), 1);
  EXPECT_EQ(reader.precision(), sizeof(btScalar) == 8 ? scenes::StoredPrecision::kFloat64
                                                      : scenes::StoredPrecision::kFloat32);
}

TEST_F(RecorderTest, SceneTellsWhatWasRecorded) {
  {
    Recorder recorder(path, options);
    add_all(recorder);
    EXPECT_TRUE(recorder.record(2.5));
  }
  const RecordingReader reader(path);
  EXPECT_TRUE(reader.finished());
  EXPECT_EQ(reader.provenance().at("engine"), scenes::kOwnLoop);
  const scenes::Scene& scene = reader.scene();
  EXPECT_EQ(scene.name, "own_world");
  EXPECT_EQ(scene.world.frame_interval, kFrames);
  EXPECT_NEAR(scene.world.gravity.y(), -9.81, 1e-6);  // single precision
  ASSERT_EQ(scene.cloths.size(), 1u);
  const ClothMesh mesh = scenes::make_mesh(scene.cloths[0]);
  EXPECT_EQ(mesh.num_nodes(), 81);
  EXPECT_EQ(mesh.triangles.cols(), 128);
  EXPECT_EQ(mesh.pinned, std::vector<int>{0});
  // setTotalMass() shares out evenly; the node that is pinned later weighs like the others again.
  EXPECT_NEAR(mesh.masses[0], mesh.masses[40], 1e-9);
  EXPECT_NEAR(mesh.masses.sum(), 0.5, 1e-6);
  ASSERT_EQ(scene.colliders.size(), 2u);
  EXPECT_NEAR(scene.colliders[0].mass.value(), 3.0, 1e-6);
  EXPECT_FALSE(scene.colliders[1].mass);
}

TEST_F(RecorderTest, MassOfFacesIsSharedOutByArea) {
  cloth->setTotalMass(btScalar(0.5), true);
  {
    Recorder recorder(path, options);
    recorder.add(*cloth, "cape");
    EXPECT_TRUE(recorder.record(0));
  }
  const ClothMesh mesh = scenes::make_mesh(RecordingReader(path).scene().cloths[0]);
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    EXPECT_NEAR(mesh.masses[i], 1 / static_cast<double>(cloth->m_nodes[i].m_im), 1e-6);
  }
}

TEST_F(RecorderTest, FacesThatAreWoundAtRandomAreASurface) {
  for (int f = 0; f < cloth->m_faces.size(); f += 3) {
    std::swap(cloth->m_faces[f].m_n[0], cloth->m_faces[f].m_n[1]);
  }
  Recorder recorder(path, options);
  EXPECT_NO_THROW(recorder.add(*cloth, "cape"));
}

TEST_F(RecorderTest, FramesKeepToTheirInterval) {
  Recorder recorder(path, options);
  add_all(recorder);
  // Steps of 1/50 s, each rounded, against frames of 1/60 s: every call is due. Then 1/240 s.
  float time = 0;
  int frames = 0;
  for (int i = 0; i < 50; ++i, time += 1.0F / 50) frames += recorder.record(time) ? 1 : 0;
  EXPECT_EQ(frames, 50);
  EXPECT_FALSE(recorder.record(time - 1.0F / 50));  // a pause
  frames = 0;
  for (int i = 0; i < 2400; ++i, time += 1.0F / 240) frames += recorder.record(time) ? 1 : 0;
  EXPECT_NEAR(frames, 600, 1);
}

TEST_F(RecorderTest, ValuesThatAreNotFiniteAreRecorded) {
  {
    Recorder recorder(path, options);
    add_all(recorder);
    EXPECT_TRUE(recorder.record(0));
    cloth->m_nodes[7].m_x.setY(std::numeric_limits<btScalar>::quiet_NaN());
    EXPECT_TRUE(recorder.record(1));
  }
  const RecordingReader reader(path);
  EXPECT_TRUE(std::isnan(reader.frame(1).cloths[0].positions(1, 7)));
}

TEST_F(RecorderTest, BlowUpIsRecordedWithAFrame) {
  options.frame_interval = 1.0;
  {
    Recorder recorder(path, options);
    add_all(recorder);
    EXPECT_TRUE(recorder.record(0.0));
    EXPECT_FALSE(recorder.record(0.1));
    recorder.blow_up(world.add_patch(3, 9.0), 0, "a body that is not recorded");
    recorder.blow_up(*cloth, 7, "speed 3e8 m/s is over 1e6 m/s");
    recorder.blow_up(*cloth, 8, "a later one");
    EXPECT_TRUE(recorder.record(0.2));
    EXPECT_FALSE(recorder.record(0.3));
    EXPECT_TRUE(recorder.record(1.0));
  }
  const RecordingReader reader(path);
  EXPECT_EQ(reader.num_frames(), 3);
  const scenes::BlowUp blow_up = reader.blow_up().value();
  EXPECT_EQ(blow_up.body, "cape");
  EXPECT_EQ(blow_up.node, 7);
  EXPECT_EQ(blow_up.step, 3);
  EXPECT_EQ(blow_up.time, 0.2);
  EXPECT_EQ(blow_up.reason, "speed 3e8 m/s is over 1e6 m/s");
}

TEST_F(RecorderTest, BlowUpOfTheLastStepIsRecorded) {
  {
    Recorder recorder(path, options);
    add_all(recorder);
    EXPECT_TRUE(recorder.record(0.5));
    recorder.blow_up(*cloth, 7, "position is not finite");
  }
  const RecordingReader reader(path);
  EXPECT_TRUE(reader.finished());
  EXPECT_EQ(reader.blow_up().value().time, 0.5);
}

TEST_F(RecorderTest, MetricsAreThoseOfTheLastCall) {
  {
    Recorder recorder(path, options);
    add_all(recorder);
    EXPECT_THAT(
        [&] { recorder.metric("energy_J", 1); },
        ThrowsMessage<InvalidArgument>(HasSubstr("'energy_J' comes before the first frame")));
    EXPECT_TRUE(recorder.record(0.0));
    recorder.metric("energy_J", 1.5);
    EXPECT_FALSE(recorder.record(0.01));
    recorder.metric("energy_J", 2.5);
  }
  const auto samples = RecordingReader(path).metric("energy_J");
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].time, 0.0);
  EXPECT_EQ(samples[0].value, 1.5);
  EXPECT_EQ(samples[1].time, 0.01);
  EXPECT_EQ(samples[1].value, 2.5);
}

TEST_F(RecorderTest, SinglePrecisionRoundsEachValueOnce) {
  options.precision = Precision::kSingle;
  {
    Recorder recorder(path, options);
    add_all(recorder);
    world.step(kStep);
    EXPECT_TRUE(recorder.record(0));
  }
  const RecordingReader reader(path);
  EXPECT_EQ(reader.precision(), scenes::StoredPrecision::kFloat32);
  EXPECT_EQ(reader.frame(0).cloths[0].positions(1, 40),
            static_cast<double>(static_cast<float>(cloth->m_nodes[40].m_x.y())));
}

TEST_F(RecorderTest, IsDrawn) {
  {
    Recorder recorder(path, options);
    add_all(recorder);
    EXPECT_TRUE(recorder.record(0));
    for (int step = 0; step < 30; ++step) world.step(kStep);
    EXPECT_TRUE(recorder.record(30 * kStep));
  }
  const RecordingReader reader(path);
  scenes::Renderer renderer(reader.scene());
  const scenes::RenderOptions small{.width = 160, .height = 90};
  const scenes::Image first = renderer.render(reader.frame(0), small);
  const scenes::Image last = renderer.render(reader.frame(1), small);
  SceneState away = reader.frame(0);
  away.cloths[0].positions.row(0).array() += 1e3;
  const scenes::Image without = renderer.render(away, small);
  EXPECT_NE(first.rgb, last.rgb);
  int changed = 0;
  for (std::size_t i = 0; i < first.rgb.size(); i += 3) {
    changed += first.rgb[i] != without.rgb[i] ? 1 : 0;
  }
  EXPECT_GT(changed, 160 * 90 / 50);  // the cloth and its shadow are in the picture
}

TEST_F(RecorderTest, RefusesWhatItCannotRecord) {
  Recorder recorder(path, options);
  const auto message = [](const char* text) {
    return ThrowsMessage<InvalidArgument>(HasSubstr(text));
  };
  EXPECT_THAT([&] { recorder.record(0); }, message("no soft body, expected at least one"));
  EXPECT_THAT([&] { recorder.add(*cloth, "my cape"); }, message("'my cape'"));
  add_all(recorder);
  EXPECT_THAT([&] { recorder.add(*ball, "cape"); },
              message("'cape' is the name of another body, expected a new one"));
  btSoftBody* rope =
      btSoftBodyHelpers::CreateRope(world.info(), btVector3(0, 0, 0), btVector3(1, 0, 0), 5, 0);
  const std::unique_ptr<btSoftBody> owned(rope);
  EXPECT_THAT([&] { recorder.add(*rope, "rope"); }, message("'rope': surface body: no triangle"));
  const btCollisionObject nothing;
  EXPECT_THAT([&] { recorder.add(nothing, "nothing"); }, message("'nothing' has no shape"));
  EXPECT_THAT([&] { recorder.record(std::nan("")); }, message("expected at least -inf and finite"));
  EXPECT_TRUE(recorder.record(1));
  EXPECT_THAT([&] { recorder.record(0.5); }, message("time = 0.5 [s], expected at least 1"));
  EXPECT_THAT([&] { recorder.add(*ball, "late"); },
              message("'late' comes after the first frame, expected all bodies before it"));
  cloth->appendNode(btVector3(0, 5, 0), 1);
  EXPECT_THAT([&] { recorder.record(2); },
              message("'cape' has 82 nodes, expected 81 as before, or Wholeness::kMayTear"));
}

TEST_F(RecorderTest, RefusesOptionsOutOfTheirDomain) {
  const auto made = [&](const RecorderOptions& given) {
    return [&, given] { const Recorder recorder(path, given); };
  };
  EXPECT_THAT(made({.frame_interval = 0}),
              ThrowsMessage<InvalidArgument>(HasSubstr("frame_interval = 0 [s], expected > 0")));
  EXPECT_THAT(made({.name = "My world"}), ThrowsMessage<InvalidArgument>(HasSubstr("My world")));
  EXPECT_THAT(made({.view = View{{1, 1, 1}, {1, 1, 1}}}),
              ThrowsMessage<InvalidArgument>(HasSubstr("expected two points")));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace weft::recorder
