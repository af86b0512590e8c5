#include <weft/playback/exchange/import/recording_import.hpp>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/exchange/exchange_body.hpp>
#include <weft/scenes/controllers/collider_path.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

constexpr double kRate = 50.0;  // [1/s]
constexpr int kSamples = 5;
const Vector3<double> kVelocity(0.5, -1.0, 2.0);       // [m/s]
const Vector3<double> kAcceleration(1.0, -9.81, 0.0);  // [m/s^2]
const Vector3<double> kSpin(0.3, 2.0, -1.0);           // [rad/s]

Vector3<double> shift(int sample) {
  const double time = sample / kRate;
  return kVelocity * time + kAcceleration * time * time / 2;
}

/// Every body of samples::make_scene() on a parabola from where the scene starts it; the ball spins too.
std::vector<ImportedBody> thrown(const Scene& scene) {
  std::vector<ImportedBody> bodies;
  for (const ExchangeBody& body : exchange_bodies(scene)) {
    ImportedBody imported{body.name, {}};
    imported.shapes.source = body.name + ".pc2";
    for (int s = 0; s < kSamples; ++s) {
      Matrix3X<double> points = body.mesh.rest_positions;
      if (body.is_rigid) {
        const Eigen::AngleAxisd turn(s / kRate * kSpin.norm(), kSpin.normalized());
        points = turn.toRotationMatrix() * points;
      }
      imported.shapes.samples.push_back(points.colwise() + shift(s));
    }
    bodies.push_back(imported);
  }
  return bodies;
}

const ImportOptions kOptions{.frame_rate = kRate, .other_start = {}};

std::string fault_of(const Scene& scene, const std::vector<ImportedBody>& bodies,
                     const ImportOptions& options = kOptions) {
  try {
    (void)import_states(scene, bodies, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

void expect_fault(const std::vector<ImportedBody>& bodies, const std::string& part) {
  const std::string fault = fault_of(samples::make_scene(), bodies);
  EXPECT_NE(fault.find(part), std::string::npos) << fault;
}

template <class Change>
std::vector<ImportedBody> changed(const Change& change) {
  std::vector<ImportedBody> bodies = thrown(samples::make_scene());
  for (Matrix3X<double>& sample : bodies[0].shapes.samples) change(sample);
  return bodies;
}

// Central differences, and a parabola through three samples at the ends, are exact for a parabola.
TEST(RecordingImport, FindsTheVelocitiesOfAThrow) {
  const Scene scene = samples::make_scene();
  const Import result = import_states(scene, thrown(scene), kOptions);
  ASSERT_EQ(result.frames.size(), static_cast<std::size_t>(kSamples));
  EXPECT_EQ(result.start_distance, 0.0);
  for (int s = 0; s < kSamples; ++s) {
    const SceneState& frame = result.frames[static_cast<std::size_t>(s)];
    const Vector3<double> expected = kVelocity + kAcceleration * (s / kRate);
    EXPECT_DOUBLE_EQ(frame.time, s / kRate);
    for (const ClothState& cloth : frame.cloths) {
      EXPECT_LT((cloth.velocities.colwise() - expected).norm(), 1e-11) << s;
    }
    EXPECT_LT((frame.rigids[0].position - shift(s)).norm(), 1e-12);
    EXPECT_LT((frame.rigids[0].velocity - expected).norm(), 1e-11);
    EXPECT_LT((frame.rigids[0].angular_velocity - kSpin).norm(), 1e-4) << "turns are not parabolas";
  }
  EXPECT_EQ(result.frames[0].cloths[1].name, "flag");
  EXPECT_EQ(result.provenance.at("engine"), kImported);
  EXPECT_NE(result.provenance.at("imported_flag").find("flag.pc2, 5 samples"), std::string::npos);
}

TEST(RecordingImport, LeavesWhatTheSceneKnowsToTheScene) {
  Scene scene = samples::make_scene();
  Collider fixed;
  fixed.name = "box";
  fixed.shape = BoxShape{{0.1, 0.1, 0.1}};
  fixed.position = {0, -3, 0};
  Collider led = fixed;
  led.name = "led";
  led.path = Path{.times = {0, 0.05, 0.1}, .points = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}}};
  led.position = led.path->points[0];
  scene.colliders.push_back(fixed);
  scene.colliders.push_back(led);
  const Import result = import_states(scene, thrown(samples::make_scene()), kOptions);
  for (const SceneState& frame : result.frames) {
    EXPECT_EQ(frame.rigids[1].position, fixed.position);
    EXPECT_EQ(frame.rigids[1].velocity, Vector3<double>(0, 0, 0));
    EXPECT_EQ(frame.rigids[2].position, prescribed_pose(led, frame.time).position);
  }
  EXPECT_GT(result.frames[2].rigids[2].velocity.norm(), 1.0);

  std::vector<ImportedBody> too_many = thrown(samples::make_scene());
  too_many.push_back({"box", too_many[0].shapes});
  EXPECT_NE(fault_of(scene, too_many).find("collider 'box' is fixed, as the scene says"),
            std::string::npos);
}

TEST(RecordingImport, RefusesBodiesThatDoNotFitTheScene) {
  std::vector<ImportedBody> bodies = thrown(samples::make_scene());
  std::vector<ImportedBody> missing(bodies.begin(), bodies.end() - 1);
  expect_fault(missing, "import: collider 'ball' of scene 'sample' has no file, expected one");
  missing.erase(missing.begin());
  expect_fault(missing, "import: cloth 'towel' of scene 'sample' has no file, expected one");
  expect_fault({}, "import: no file");
  bodies[1].name = "towel";
  expect_fault(bodies, "flag.pc2: body 'towel' is given twice");
  bodies[1].name = "curtain";
  expect_fault(bodies, "flag.pc2: scene 'sample' has no body 'curtain'");
}

TEST(RecordingImport, RefusesNumbersThatDoNotFit) {
  expect_fault(changed([](Matrix3X<double>& sample) { sample.conservativeResize(3, 24); }),
               "towel.pc2: has 24 points, expected the 25 nodes of body 'towel'");
  std::vector<ImportedBody> bodies = thrown(samples::make_scene());
  bodies[1].shapes.samples.pop_back();
  expect_fault(bodies, "flag.pc2: has 4 samples 1 frames apart, expected 5 samples 1 frames apart");
  for (ImportedBody& body : bodies) body.shapes.samples.resize(1);
  expect_fault(bodies, "towel.pc2: has 1 sample, expected at least 2");
  EXPECT_EQ(fault_of(samples::make_scene(), thrown(samples::make_scene()), {.frame_rate = 0.0}),
            "import: frame rate = 0 [1/s], expected > 0");
  bodies = thrown(samples::make_scene());
  bodies[0].shapes.faces = {{0, 1, 2}};
  bodies[0].shapes.faces_source = "towel.obj";
  expect_fault(bodies, "towel.obj: body 'towel': the faces are 1 triangles, expected 32");
}

TEST(RecordingImport, RefusesAnotherStart) {
  const std::string elsewhere = "towel.pc2: the first sample of body 'towel' is up to ";
  expect_fault(changed([](Matrix3X<double>& sample) { sample *= 1.02; }), elsewhere);
  expect_fault(changed([](Matrix3X<double>& sample) { sample.row(0) *= -1; }), elsewhere);
  expect_fault(changed([](Matrix3X<double>& sample) { sample.col(3).swap(sample.col(9)); }),
               elsewhere);
  std::vector<ImportedBody> late = thrown(samples::make_scene());
  for (ImportedBody& body : late) body.shapes.samples.erase(body.shapes.samples.begin());
  expect_fault(late, elsewhere);
  const Import result =
      import_states(samples::make_scene(), late, {.frame_rate = kRate, .other_start = "a throw"});
  // The cloths are as far as the throw; points of the ball, which spins, go a little farther.
  constexpr double kBallRadius = 0.5;  // [m]
  EXPECT_GE(result.start_distance, shift(1).norm());
  EXPECT_LE(result.start_distance, shift(1).norm() + kBallRadius * kSpin.norm() / kRate);
  EXPECT_NE(result.provenance.at("imported_start").find("m from the scene's: a throw"),
            std::string::npos);
}

TEST(RecordingImport, RefusesABallThatIsNotRigid) {
  std::vector<ImportedBody> bodies = thrown(samples::make_scene());
  bodies[2].shapes.samples[3] *= 1.02;
  expect_fault(bodies, "ball.pc2: sample 3: a point is 0.0");
  bodies = thrown(samples::make_scene());
  bodies[2].shapes.samples[0].array() += 1e-3;
  expect_fault(bodies, "ball.pc2: the first sample of body 'ball' is up to 0.00173 m from");
}

}  // namespace
}  // namespace weft::scenes
