#include <weft/playback/exchange/gltf/gltf_export.hpp>

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <weft/playback/exchange/gltf/glb_writer.hpp>
#include <weft/playback/exchange/gltf/gltf_material.hpp>
#include <weft/playback/exchange/gltf/tracked_nodes.hpp>
#include <weft/playback/exchange/unfit_recording.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/scenes/cloth_tear.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// The file, decoded as far as these tests need it; gltf_export_check.py reads the numbers.
struct Document {
  explicit Document(const std::string& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    root = json::parse(bytes.substr(20, length));
    binary = bytes.substr(20 + length + 8);
  }

  [[nodiscard]] const json& node(const std::string& name) const {
    for (const json& node : root.at("nodes")) {
      if (node.at("name") == name && !node.contains("children")) return node;
    }
    throw std::out_of_range(name);
  }
  [[nodiscard]] const json& mesh(const std::string& name) const {
    return root.at("meshes").at(node(name).at("mesh").get<std::size_t>());
  }
  [[nodiscard]] const json& material(const std::string& name) const {
    const json& primitive = mesh(name).at("primitives").at(0);
    return root.at("materials").at(primitive.at("material").get<std::size_t>());
  }
  [[nodiscard]] std::string image(std::size_t index) const {
    const json& view =
        root.at("bufferViews").at(root.at("images").at(index).at("bufferView").get<std::size_t>());
    return binary.substr(view.at("byteOffset"), view.at("byteLength"));
  }
  [[nodiscard]] const json& accessor(const json& index) const {
    return root.at("accessors").at(index.get<std::size_t>());
  }

  json root;
  std::string binary;
};

GltfExport exported(const samples::TemporaryFolder& folder, const Scene& scene, int num_frames = 9,
                    const GltfOptions& options = {}) {
  samples::write_sample(folder / "a.weftrec", scene, StoredPrecision::kFloat64, num_frames);
  return export_gltf(RecordingReader(folder / "a.weftrec"), options);
}

/// Why a recording of the states of the frames, changed by change(), is refused.
template <class Change>
std::string fault_of(const samples::TemporaryFolder& folder, const Change& change) {
  const Scene scene = samples::make_scene();
  {
    RecordingWriter writer(folder / "a.weftrec", scene, {}, StoredPrecision::kFloat64);
    for (int frame = 0; frame < 3; ++frame) {
      SceneState state = samples::make_state(scene, frame, StoredPrecision::kFloat64);
      change(frame, state);
      writer.add_frame(state);
    }
    writer.finish();
  }
  try {
    (void)export_gltf(RecordingReader(folder / "a.weftrec"), {});
  } catch (const UnfitRecording& error) {
    return error.what();
  }
  return "none";
}

Scene scene_with_drawn_mesh() {
  Scene scene = samples::make_scene();
  const ClothMesh fine = make_cloth_grid({.nodes = {17, 17}, .center = {0, 0.01, 0}});
  scene.cloths[1].drawn_mesh = DrawnCloth{std::make_shared<const Surface>(
      Surface{fine.rest_positions, fine.triangles, fine.texture_coordinates})};
  return scene;
}

TEST(GltfExport, ADrawnMeshStandsInPlaceOfItsCloth) {
  const samples::TemporaryFolder folder;
  const Document document(exported(folder, scene_with_drawn_mesh()).bytes);
  const json& drawn = document.mesh("flag").at("primitives").at(0);
  const json& attributes = drawn.at("attributes");
  EXPECT_EQ(document.accessor(attributes.at("POSITION")).at("count"), 17 * 17);
  EXPECT_EQ(document.accessor(drawn.at("indices")).at("count"), 3 * 2 * 16 * 16);
  EXPECT_TRUE(attributes.contains("NORMAL"));
  EXPECT_FALSE(attributes.contains("_NODE"));
  EXPECT_TRUE(drawn.at("targets").at(0).contains("POSITION"));
  const json& plain = document.mesh("towel").at("primitives").at(0).at("attributes");
  EXPECT_EQ(document.accessor(plain.at("POSITION")).at("count"), 25);
}

TEST(GltfExport, HasAMeshForEveryBodyAndItsErrorInside) {
  const samples::TemporaryFolder folder;
  const GltfExport result = exported(folder, samples::make_scene());
  EXPECT_TRUE(kGlbKind.recognizes(std::string_view(result.bytes).substr(0, 4096)));
  const Document document(result.bytes);
  ASSERT_EQ(result.report.cloths.size(), 2U);
  EXPECT_EQ(result.report.num_rigid_bodies, 1);
  const json& extras = document.root["asset"]["extras"];
  EXPECT_EQ(extras["error_m"], 1e-3);
  for (std::size_t c = 0; c < 2; ++c) {
    const GltfClothReport& cloth = result.report.cloths[c];
    EXPECT_LE(cloth.largest_error, 1e-3);
    EXPECT_EQ(extras["cloths"][c]["largest_error_m"], cloth.largest_error);
    EXPECT_EQ(extras["cloths"][c]["morph_targets"], cloth.num_targets);
    // sin(phase + speed t) is the sum of two shapes.
    EXPECT_EQ(cloth.num_targets, 2);
    EXPECT_EQ(document.mesh(cloth.name)["primitives"][0]["targets"].size(), 2U);
    EXPECT_EQ(document.material(cloth.name)["doubleSided"], true);
  }
}

TEST(GltfExport, ACutOffBasisSaysThatItIsFartherAway) {
  const samples::TemporaryFolder folder;
  const GltfExport result = exported(folder, samples::make_scene(), 60, {1e-3, 1});
  for (const GltfClothReport& cloth : result.report.cloths) {
    EXPECT_FALSE(cloth.is_within_error);
    EXPECT_GT(cloth.largest_error, 1e-2);
  }
  const Document document(result.bytes);
  EXPECT_EQ(document.root["asset"]["extras"]["cloths"][0]["is_within_error"], false);
}

TEST(GltfExport, GivesTheSameBytesAgain) {
  const samples::TemporaryFolder first;
  const std::string bytes = exported(first, samples::make_scene()).bytes;
  EXPECT_EQ(export_gltf(RecordingReader(first / "a.weftrec"), {}).bytes, bytes);
}

TEST(GltfExport, KeepsTheTimesOfFrames) {
  const samples::TemporaryFolder folder;
  const Document document(exported(folder, samples::make_scene()).bytes);
  const json& animation = document.root["animations"].at(0);
  EXPECT_EQ(animation["channels"].size(), 4U) << "two cloths, the ball's place and its turn";
  for (const json& sampler : animation["samplers"]) {
    const json& input = document.accessor(sampler["input"]);
    EXPECT_EQ(input["count"], 9);
    EXPECT_EQ(input["min"][0].get<float>(), 0.0f);
    EXPECT_EQ(input["max"][0].get<float>(), static_cast<float>(8 / 60.0));
  }
}

TEST(GltfExport, RefusesWhatIsNotFinite) {
  const auto nan_node = [](int frame, SceneState& state) {
    if (frame == 2) state.cloths[1].positions(1, 7) = std::nan("");
  };
  EXPECT_THAT(
      fault_of(samples::TemporaryFolder(), nan_node),
      HasSubstr("frame 2, t = 0.0333333 s: position of node 7 of cloth 'flag' is not finite"));
  const auto far_node = [](int frame, SceneState& state) {
    if (frame == 1) state.cloths[0].positions(0, 3) = 1e39;
  };
  EXPECT_THAT(fault_of(samples::TemporaryFolder(), far_node),
              HasSubstr("position of node 3 of cloth 'towel' is not finite in single precision"));
  const auto lost_ball = [](int frame, SceneState& state) {
    if (frame == 1) state.rigids[0].orientation.coeffs().setZero();
  };
  EXPECT_THAT(fault_of(samples::TemporaryFolder(), lost_ball),
              HasSubstr("frame 1, t = 0.0166667 s: orientation of rigid body 'ball'"));
  const auto nothing = [](int, SceneState&) {};
  EXPECT_EQ(fault_of(samples::TemporaryFolder(), nothing), "none");
}

TEST(GltfExport, RefusesTimesThatSinglePrecisionCannotTellApart) {
  const auto late = [](int, SceneState& state) { state.time += 1e6; };
  EXPECT_THAT(fault_of(samples::TemporaryFolder(), late),
              HasSubstr("frame 1 is at t = 1000000.02 s, expected a later time than that before"));
}

TEST(GltfExport, TurnsASceneWhoseZIsUp) {
  for (const Vector3<double>& gravity :
       {Vector3<double>(0, -9.81, 0), Vector3<double>(0, 0, -9.81), Vector3<double>(1.0, 0, 0.2)}) {
    const samples::TemporaryFolder folder;
    Scene scene = samples::make_scene();
    scene.world.gravity = gravity;
    const Document document(exported(folder, scene, 2).bytes);
    const json& top =
        document.root["nodes"].at(document.root["scenes"][0]["nodes"][0].get<std::size_t>());
    const json& turn = top["rotation"];
    const Eigen::Quaterniond rotation(turn[3], turn[0], turn[1], turn[2]);
    EXPECT_LT((rotation * gravity).normalized().y(), -0.9) << gravity.transpose();
    EXPECT_EQ(rotation.w() == 1.0, gravity.y() != 0.0);
    EXPECT_EQ(top["children"].size(), 4U) << "three bodies and the camera";
  }
}

TEST(GltfExport, LeavesOutPlanesAndWhatIsNotVisible) {
  const samples::TemporaryFolder folder;
  Scene scene = samples::make_scene();
  scene.cloths[0].appearance.visible = false;
  Collider plane;
  plane.name = "ground";
  plane.shape = PlaneShape{};
  scene.colliders.push_back(plane);
  const GltfExport result = exported(folder, scene, 2);
  EXPECT_THAT(result.report.left_out, ElementsAre("towel", "ground"));
  EXPECT_EQ(result.report.cloths.size(), 1U);
}

TEST(GltfExport, HasColorsAndPictures) {
  const samples::TemporaryFolder folder;
  Scene scene = samples::make_scene();
  scene.cloths[0].appearance.color = Rgb{255, 0, 0};
  scene.cloths[1].appearance.pattern = Pattern::kChecks;
  scene.cloths[1].appearance.texture_repeat = {3.0, 2.0};
  const Document document(exported(folder, scene, 2).bytes);
  const json& red = document.material("towel")["pbrMetallicRoughness"];
  EXPECT_EQ(red["baseColorFactor"], json({1.0, 0.0, 0.0, 1.0}));
  const json& checks = document.material("flag")["pbrMetallicRoughness"];
  EXPECT_EQ(checks["baseColorTexture"]["index"], 0);
  const Image image = decode_image(document.image(0));
  EXPECT_EQ(image.width, 512);
  const json& places =
      document.accessor(document.mesh("flag")["primitives"][0]["attributes"]["TEXCOORD_0"]);
  EXPECT_EQ(places["min"], json({0.0, -1.0})) << "v counts from the top of the picture";
  EXPECT_EQ(places["max"], json({3.0, 1.0}));
  // A plain moving ball shows by two colors how it turns.
  EXPECT_EQ(document.mesh("ball")["primitives"].size(), 2U);
}

TEST(GltfExport, TakesAJpegAlongAsItIs) {
  const samples::TemporaryFolder folder;
  Scene scene = samples::make_scene();
  const std::string jpeg = encode_jpeg(Image{8, 8, std::vector<std::uint8_t>(192, 90)});
  scene.files.push_back({"photo.jpg", jpeg});
  for (Cloth& cloth : scene.cloths) cloth.appearance.image = "photo.jpg";
  const Document document(exported(folder, scene, 2).bytes);
  EXPECT_EQ(document.root["images"].size(), 1U) << "two cloths share it";
  EXPECT_EQ(document.root["images"][0]["mimeType"], "image/jpeg");
  EXPECT_EQ(document.image(0), jpeg);
}

TEST(GltfExport, WritesARopeAsLines) {
  const samples::TemporaryFolder folder;
  Scene scene;
  scene.name = "sample";
  scene.summary = "Shows a sample.";
  Cloth rope;
  rope.name = "rope";
  rope.source = Rope{.nodes = 25};
  scene.cloths.push_back(rope);
  {
    RecordingWriter writer(folder / "a.weftrec", scene, {}, StoredPrecision::kFloat64);
    for (int frame = 0; frame < 3; ++frame) {
      SceneState state;
      state.time = 0.5 * frame;
      const Matrix3X<double> rest = make_mesh(rope).rest_positions;
      state.cloths.push_back({"rope", (1.0 + frame) * rest, Matrix3X<double>::Zero(3, 25)});
      writer.add_frame(state);
    }
    writer.finish();
  }
  const Document document(export_gltf(RecordingReader(folder / "a.weftrec"), {}).bytes);
  const json& primitive = document.mesh("rope")["primitives"][0];
  EXPECT_EQ(primitive["mode"], 1);
  EXPECT_EQ(document.accessor(primitive["indices"])["count"], 48);
  EXPECT_FALSE(primitive["attributes"].contains("NORMAL"));
  EXPECT_EQ(primitive["targets"].size(), 1U) << "it stretches in one way";
}

TEST(PlaceInPicture, GoesAroundABall) {
  const auto place = [](TextureMapping mapping, double x, double y, double z) {
    return place_in_picture(mapping, {x, y, z});
  };
  EXPECT_NEAR(place(TextureMapping::kByDirection, 0, 0, 2).x(), 0.5, 1e-12);
  EXPECT_NEAR(place(TextureMapping::kByDirection, 2, 0, 0).x(), 0.75, 1e-12);
  EXPECT_NEAR(place(TextureMapping::kByDirection, 1, 1, 0).y(), 0.25, 1e-12);
  EXPECT_NEAR(place(TextureMapping::kFromFront, 0, 0, 1).x(), 0.5, 1e-12);
  EXPECT_NEAR(place(TextureMapping::kFromFront, 1, 0, 0).x(), 0.75, 1e-12);
  EXPECT_NEAR(place(TextureMapping::kFromFront, 0, 0, -1).x(), 1.0, 1e-12);
}

TEST(CornerPlaces, DoNotRunBackOverTheSeam) {
  ClothMesh mesh;
  mesh.rest_positions.resize(3, 6);
  mesh.rest_positions << 1, -1, 0.2, -0.2, 0, 0,  //
      0, 0, 0, 0, 1, -1,                          //
      0, 0, -1, -1, 0, 2;
  mesh.rest_positions.row(2).array() -= mesh.rest_positions.row(2).mean();
  mesh.rest_positions(2, 4) = 0;  // a pole, straight above the middle
  mesh.rest_positions.row(2).head(4).array() -= mesh.rest_positions.row(2).mean() * 6 / 4;
  mesh.triangles = Triangles(3, 1);
  mesh.triangles << 2, 3, 4;
  const Matrix2X<double> places = corner_places(TextureMapping::kByDirection, mesh);
  EXPECT_LT(std::abs(places(0, 0) - places(0, 1)), 0.5);
  EXPECT_LT(std::abs(places(0, 0) - places(0, 2)), 0.5);
}

/// Two triangles with a common side, nodes 0 and 2, which then comes apart at node 2 and at node 0.
TEST(TrackedNodes, AreOneNodeBeforeTheyTear) {
  ClothMesh whole;
  whole.rest_positions = Matrix3X<double>::Random(3, 4);
  whole.triangles = Triangles(3, 2);
  whole.triangles << 0, 0, 1, 2, 2, 3;
  whole.edge_sets.push_back({"stretch", Edges(2, 0)});
  auto first = std::make_shared<ClothTopology>();
  first->triangles = whole.triangles;
  first->triangles(1, 1) = 4;
  first->origins = {2};
  auto last = std::make_shared<ClothTopology>(*first);
  last->triangles(0, 1) = 5;
  last->origins = {2, 0};

  TrackedNodes tracked(whole, last);
  ClothState state{"sheet", Matrix3X<double>::Zero(3, 4), Matrix3X<double>::Zero(3, 4)};
  EXPECT_THAT(tracked.nodes(state), ElementsAre(0, 1, 2, 3, 2, 0));
  state.positions.setZero(3, 5);
  state.topology = first;
  EXPECT_THAT(tracked.nodes(state), ElementsAre(0, 1, 2, 3, 4, 0));
  state.positions.setZero(3, 6);
  state.topology = last;
  EXPECT_THAT(tracked.nodes(state), ElementsAre(0, 1, 2, 3, 4, 5));
  // A tear that has closed in the last frame.
  TrackedNodes closing(whole, first);
  EXPECT_THROW((void)closing.nodes(state), UnfitRecording);
}

}  // namespace
}  // namespace weft::scenes
