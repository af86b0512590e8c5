#include <weft/playback/exchange/point_cache_export.hpp>

#include <fstream>
#include <memory>
#include <sstream>

#include <gtest/gtest.h>

#include <weft/playback/exchange/exchange_body.hpp>
#include <weft/playback/exchange/obj_file.hpp>
#include <weft/playback/exchange/point_cache.hpp>
#include <weft/playback/exchange/unfit_recording.hpp>
#include <weft/scenes/cloth_tear.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string fault_of(const samples::TemporaryFolder& folder) {
  const RecordingReader reader(folder / "a.weftrec");
  try {
    export_point_caches(reader, point_cache_folder(folder / "out"));
  } catch (const UnfitRecording& error) {
    return error.what();
  }
  return "none";
}

TEST(PointCacheExport, HoldsEveryFrameOfEveryBody) {
  const samples::TemporaryFolder folder;
  const Scene scene = samples::make_scene();
  samples::write_sample(folder / "a.weftrec", scene, StoredPrecision::kFloat64, 9);
  const RecordingReader reader(folder / "a.weftrec");
  const PointCacheReport report = export_point_caches(reader, point_cache_folder(folder / "out"));
  EXPECT_EQ(report.num_bodies, 3);
  EXPECT_NEAR(report.frame_interval, 1.0 / 60, 1e-12);
  EXPECT_GT(report.largest_rounding, 0.0);
  EXPECT_LT(report.largest_rounding, 2e-7) << "half a unit in the last place of 3.5 m";
  for (const ExchangeBody& body : exchange_bodies(scene)) {
    const PointCache cache =
        decode_point_cache(content(folder / ("out/" + body.file_name + ".pc2")), body.file_name);
    ASSERT_EQ(cache.samples.size(), 9U);
    for (int frame = 0; frame < 9; ++frame) {
      const Matrix3X<double> expected = world_positions(body, reader.frame(frame));
      EXPECT_EQ(cache.samples[static_cast<std::size_t>(frame)], expected.cast<float>());
    }
  }
}

// The drawn mesh is flat and lies around the cloth of 1 m x 1 m at rest.
TEST(PointCacheExport, WritesADrawnMeshBesideItsCloth) {
  const samples::TemporaryFolder folder;
  Scene scene = samples::make_scene();
  const ClothMesh fine = make_cloth_grid({.nodes = {17, 17}, .center = {0, 0.01, 0}});
  scene.cloths[1].drawn_mesh =
      DrawnCloth{std::make_shared<const Surface>(Surface{fine.rest_positions, fine.triangles})};
  samples::write_sample(folder / "a.weftrec", scene, StoredPrecision::kFloat64, 3);
  const RecordingReader reader(folder / "a.weftrec");
  EXPECT_EQ(export_point_caches(reader, point_cache_folder(folder / "out")).num_bodies, 4);
  const PointCache cloth = decode_point_cache(content(folder / "out/flag.pc2"), "flag");
  const PointCache drawn = decode_point_cache(content(folder / "out/flag-drawn.pc2"), "drawn");
  EXPECT_EQ(cloth.samples[2].cols(), 25);
  ASSERT_EQ(drawn.samples[2].cols(), 17 * 17);
  const ClothMesh mesh = make_mesh(scene.cloths[1]);
  const ClothEmbedding embedding(mesh.rest_positions, mesh.triangles,
                                 {fine.rest_positions, fine.triangles});
  ClothPose pose = embedding.make_pose();
  embedding.set_pose(reader.frame(2).cloths[1].positions, pose);
  for (int v = 0; v < embedding.num_vertices(); ++v) {
    EXPECT_EQ(drawn.samples[2].col(v), embedding.vertex(pose, v).position.cast<float>());
  }
  EXPECT_NE(content(folder / "out/flag-drawn.obj").find("o flag-drawn\n"), std::string::npos);
}

TEST(PointCacheExport, TurnsARigidBodyAboutItsCenter) {
  const Scene scene = samples::make_scene();
  const ExchangeBody ball = exchange_bodies(scene).back();
  ASSERT_TRUE(ball.is_rigid);
  SceneState state = samples::make_state(scene, 3, StoredPrecision::kFloat64);
  state.rigids[0].orientation.normalize();
  SceneState later = state;
  constexpr double kStep = 1e-6;  // [s]
  const Vector3<double> turn = kStep * state.rigids[0].angular_velocity;
  later.rigids[0].position += kStep * state.rigids[0].velocity;
  later.rigids[0].orientation =
      Eigen::AngleAxisd(turn.norm(), turn.normalized()) * state.rigids[0].orientation;
  const Matrix3X<double> difference =
      (world_positions(ball, later) - world_positions(ball, state)) / kStep;
  EXPECT_LT((difference - world_velocities(ball, state)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(PointCacheExport, RefusesAPositionThatIsNotFinite) {
  const samples::TemporaryFolder folder;
  const Scene scene = samples::make_scene();
  {
    RecordingWriter writer(folder / "a.weftrec", scene, {}, StoredPrecision::kFloat64);
    for (int frame = 0; frame < 3; ++frame) {
      SceneState state = samples::make_state(scene, frame, StoredPrecision::kFloat64);
      if (frame == 2) state.cloths[1].positions(1, 7) = std::nan("");
      writer.add_frame(state);
    }
    writer.finish();
  }
  EXPECT_NE(fault_of(folder).find("frame 2, t = 0.0333333 s: position of node 7 of cloth 'flag'"),
            std::string::npos)
      << fault_of(folder);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/towel.pc2"));
}

TEST(PointCacheExport, RefusesFramesThatAreNotEquallySpaced) {
  const samples::TemporaryFolder folder;
  const Scene scene = samples::make_scene();
  {
    RecordingWriter writer(folder / "a.weftrec", scene, {}, StoredPrecision::kFloat64);
    for (const int frame : {0, 1, 3}) {
      writer.add_frame(samples::make_state(scene, frame, StoredPrecision::kFloat64));
    }
    writer.finish();
  }
  EXPECT_NE(fault_of(folder).find("frame 1 is at t = 0.0166667 s, expected 0.025 s"),
            std::string::npos)
      << fault_of(folder);
}

TEST(ObjText, HasPointsPlacesAndTriangles) {
  ClothMesh mesh;
  mesh.rest_positions = Matrix3X<double>::Identity(3, 3) / 3.0;
  mesh.triangles = Triangles(3, 1);
  mesh.triangles << 0, 1, 2;
  EXPECT_EQ(obj_text("sheet", mesh),
            "# Weft, lengths in m, y is up\no sheet\nv 0.3333333333333333 0 0\n"
            "v 0 0.3333333333333333 0\nv 0 0 0.3333333333333333\nf 1 2 3\n");
  mesh.corner_texture_coordinates = Matrix2X<double>::Zero(2, 3);
  EXPECT_NE(obj_text("sheet", mesh).find("vt 0 0\nvt 0 0\nvt 0 0\nf 1/1 2/2 3/3\n"),
            std::string::npos);
}

TEST(ObjText, WritesARopeAsLines) {
  ClothMesh mesh;
  mesh.rest_positions = Matrix3X<double>::Zero(3, 3);
  mesh.triangles = Triangles(3, 0);
  Edges edges(2, 2);
  edges << 0, 1, 1, 2;
  mesh.edge_sets.push_back({"stretch", edges});
  EXPECT_NE(obj_text("rope", mesh).find("l 1 2\nl 2 3\n"), std::string::npos);
}

TEST(ExchangeBodies, HaveNamesThatFilesCanHave) {
  Scene scene = samples::make_scene();
  scene.cloths[0].name = "a/b";
  scene.cloths[1].name = "a b";
  Collider plane;
  plane.name = "ground";
  plane.shape = PlaneShape{};
  scene.colliders.push_back(plane);
  const std::vector<ExchangeBody> bodies = exchange_bodies(scene);
  ASSERT_EQ(bodies.size(), 3U) << "a plane has no border";
  EXPECT_EQ(bodies[0].file_name, "a_b");
  EXPECT_EQ(bodies[1].file_name, "a_b-2");
}

}  // namespace
}  // namespace weft::scenes
