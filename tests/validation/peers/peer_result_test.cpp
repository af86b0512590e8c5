#include <weft/validation/peers/peer_result.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

TEST(PeerResults, StartAsTheSameSceneDoesInWeft) {
  ASSERT_EQ(peer_texts().size(), 2U);
  for (const std::string_view text : peer_texts()) {
    const PeerResult peer = read_peer_result(text);
    const ClothMesh mesh = scenes::make_mesh(peer.scene.cloths.front());
    ASSERT_FALSE(peer.positions.empty());
    EXPECT_EQ(peer.times.front(), 0.0);
    // The stored places are rounded to 1e-5 m; Blender's are single precision at 3.5 m.
    EXPECT_LT((peer.positions.front() - mesh.rest_positions).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_NEAR(mesh.masses.minCoeff(), mesh.masses.maxCoeff(), 1e-15);
  }
}

TEST(PeerResults, AreStoredOnlyWithAMappingThatHolds) {
  for (const std::string_view text : peer_texts()) {
    const PeerResult peer = read_peer_result(text);
    EXPECT_FALSE(peer.mapping.empty());
    ASSERT_EQ(peer.calibration.size(), 2U);
    for (const PeerResult::Calibration& check : peer.calibration) {
      // What blender_cloth.py demands before it writes.
      EXPECT_LT(std::abs(check.measured / check.expected - 1), 0.02) << check.what;
    }
  }
}

TEST(PeerResults, OtherTextIsAnError) {
  EXPECT_THROW((void)read_peer_result("{}"), Error);
  EXPECT_THROW((void)read_peer_result("no JSON"), Error);
  EXPECT_THROW((void)read_peer_result(R"({"schema": "weft-peer/2"})"), Error);
}

}  // namespace
}  // namespace weft::validation
