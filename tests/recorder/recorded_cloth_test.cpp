#include <weft/recorder/recorded_cloth.hpp>

#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/bridge/tearing.hpp>
#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/recorder/recorder.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "tests/recorder/small_world.hpp"
#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::recorder {
namespace {

using scenes::samples::TemporaryFolder;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A sheet of 2 m x 2 m in the plane y = 0 that is cut while it falls.
struct TornClothTest : testing::Test {
  TornClothTest() {
    mesh = make_cloth_grid({.nodes = {9, 9}, .size = {2.0, 2.0}, .total_mass = 1.0});
    first = mesh;
    body = &world.add(bridge::make_cloth_body(world.info(), mesh, {}));
  }
  /// From x = from to x = to, along the given z.
  Tear cut(double z, double from, double to) {
    return bridge::cut(solver, *body, mesh, {}, {}, {{from, 0, z}, {to, 0, z}, {0, 1, 0}});
  }

  TemporaryFolder folder;
  std::filesystem::path path = folder / "torn.weftrec";
  bridge::SoftBodySolver solver;
  SmallWorld world{&solver};
  ClothMesh mesh;
  ClothMesh first;
  btSoftBody* body = nullptr;
};

TEST_F(TornClothTest, IsRecordedAsItTears) {
  std::vector<int> split;
  {
    Recorder recorder(path);
    recorder.add(*body, "sheet", Wholeness::kMayTear);
    EXPECT_TRUE(recorder.record(0));
    const Tear tear = cut(0.1, -2, 0);
    ASSERT_TRUE(tear.any());
    split = tear.origins;
    EXPECT_TRUE(recorder.record(1));
    EXPECT_TRUE(recorder.record(2));
    ASSERT_TRUE(cut(0.1, -2, 2).any());
    EXPECT_TRUE(recorder.record(3));
  }
  const scenes::RecordingReader reader(path);
  ASSERT_EQ(reader.num_frames(), 4);
  EXPECT_EQ(reader.frame(0).cloths[0].topology, nullptr);
  const auto cut_once = reader.frame(2).cloths[0].topology;
  ASSERT_NE(cut_once, nullptr);
  EXPECT_EQ(cut_once->origins, split);
  const scenes::ClothState last = reader.frame(3).cloths[0];
  ASSERT_NE(last.topology, nullptr);
  EXPECT_EQ(last.topology->triangles, mesh.triangles);
  ASSERT_EQ(last.positions.cols(), mesh.num_nodes());
  for (int node = first.num_nodes(); node < mesh.num_nodes(); ++node) {
    const int origin = last.topology->origins[static_cast<std::size_t>(node - first.num_nodes())];
    EXPECT_EQ(mesh.rest_positions.col(node), first.rest_positions.col(origin));
  }
  EXPECT_NO_THROW((void)scenes::Renderer(reader.scene()).render(reader.frame(3), {}));
}

TEST_F(TornClothTest, FacesThatAreWoundInAnotherWayAreFollowed) {
  std::swap(body->m_faces[5].m_n[0], body->m_faces[5].m_n[1]);
  const scenes::Cloth cloth = recorded_cloth(*body, "sheet");
  const Triangles triangles = scenes::make_mesh(cloth).triangles;
  const FollowedFaces faces(*body, triangles);
  const int corner = triangles(2, 5);
  body->appendNode(btVector3(0, 0, 0), 1);
  for (int f = 0; f < body->m_faces.size(); ++f) {
    for (auto& node : body->m_faces[f].m_n) {
      if (f == 5 && node == &body->m_nodes[corner]) node = &body->m_nodes[81];
    }
  }
  const auto topology = faces.now(*body);
  EXPECT_EQ(topology->origins, std::vector<int>{corner});
  Triangles expected = triangles;
  expected(2, 5) = 81;
  EXPECT_EQ(topology->triangles, expected);
}

TEST_F(TornClothTest, RefusesWhatIsNoTear) {
  const FollowedFaces faces(*body, mesh.triangles);
  body->appendNode(btVector3(0, 0, 0), 1);
  EXPECT_THAT([&] { (void)faces.now(*body); },
              ThrowsMessage<InvalidArgument>(HasSubstr("node 81 belongs to no face")));
  body->m_faces[0].m_n[0] = &body->m_nodes[80];
  EXPECT_THAT([&] { (void)faces.now(*body); },
              ThrowsMessage<InvalidArgument>(HasSubstr("face 0 has node 80 in place of node")));
  body->appendFace(0, 1, 81);
  EXPECT_THAT([&] { (void)faces.now(*body); },
              ThrowsMessage<InvalidArgument>(
                  HasSubstr("has 129 faces, expected 128 as when it was added")));
}

TEST_F(TornClothTest, ABodyWithFewerNodesIsRefused) {
  Recorder recorder(path);
  recorder.add(*body, "sheet", Wholeness::kMayTear);
  ASSERT_TRUE(cut(0.1, -2, 0).any());
  EXPECT_TRUE(recorder.record(0));
  body->m_nodes.pop_back();
  EXPECT_THAT([&] { recorder.record(1); },
              ThrowsMessage<InvalidArgument>(HasSubstr("as before or more")));
}

}  // namespace
}  // namespace weft::recorder
