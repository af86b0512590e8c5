#include <gtest/gtest.h>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_state;
using samples::TemporaryFolder;

MeshBody tetrahedron(double height) {
  Surface surface;
  surface.positions.resize(3, 4);
  surface.positions << 0, 1, 0, 0,  //
      0, 0, height, 0,              //
      0, 0, 0, 1;
  surface.triangles.resize(3, 4);
  surface.triangles << 0, 0, 0, 1,  //
      2, 1, 3, 2,                   //
      1, 3, 2, 3;
  surface.corner_texture_coordinates = Matrix2X<double>::Constant(2, 12, 1.0 / 3.0);
  MeshBody body;
  body.shape = std::make_shared<const MeshGeometry>(MeshGeometry{surface});
  body.position = {0.1, 0.2, 0.3};
  return body;
}

Scene scene_of(double height) {
  Scene scene = samples::make_scene();
  scene.cloths.resize(1);
  scene.cloths[0].source = tetrahedron(height);
  return scene;
}

std::string record(const std::filesystem::path& path, const Scene& scene) {
  RecordingWriter writer(path, scene, {}, StoredPrecision::kFloat64);
  SceneState state = make_state(samples::make_scene(2), 0, StoredPrecision::kFloat64);
  state.cloths.resize(1);
  writer.add_frame(state);
  return writer.finish();
}

TEST(RecordedMesh, IsInTheRecordingBitForBit) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(1.0 / 3.0);
  (void)record(folder / "mesh.weftrec", scene);
  const RecordingReader reader(folder / "mesh.weftrec");
  const ClothMesh before = make_mesh(scene.cloths[0]);
  const ClothMesh after = make_mesh(reader.scene().cloths.at(0));
  EXPECT_TRUE(samples::same_bits(before.rest_positions, after.rest_positions));
  EXPECT_EQ(before.triangles, after.triangles);
  EXPECT_TRUE(
      samples::same_bits(before.corner_texture_coordinates, after.corner_texture_coordinates));
  EXPECT_EQ(reader.frame(0).cloths.at(0).positions.cols(), 4);
}

TEST(RecordedMesh, IsCoveredByTheContentHash) {
  const TemporaryFolder folder;
  const std::string hash = record(folder / "first.weftrec", scene_of(0.5));
  EXPECT_EQ(record(folder / "same.weftrec", scene_of(0.5)), hash);
  EXPECT_NE(record(folder / "other.weftrec", scene_of(std::nextafter(0.5, 1.0))), hash);
}

}  // namespace
}  // namespace weft::scenes
