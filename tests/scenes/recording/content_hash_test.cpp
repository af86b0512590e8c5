#include <bit>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include <weft/scenes/recording/codec/stream_hash.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::TemporaryFolder;
using samples::write_sample;

TEST(StreamHash, IsXxh3With128Bits) {
  // What the command "printf abc | xxh128sum" prints.
  StreamHash hash;
  const std::string text = "abc";
  hash.add(std::as_bytes(std::span(text)));
  EXPECT_EQ(hash.hex(), "06b05ab6733a618578af5f94892f3950");
}

TEST(ContentHash, DoesNotDependOnChunksNorProvenance) {
  const TemporaryFolder folder;
  std::set<std::string> hashes;
  for (const auto& [name, limits] :
       {std::pair{"a", ChunkLimits{}}, std::pair{"b", ChunkLimits{1, 1}},
        std::pair{"c", ChunkLimits{7, 1 << 20}}, std::pair{"d", ChunkLimits{64, 3000}}}) {
    hashes.insert(write_sample(folder / name, make_scene(), StoredPrecision::kFloat32, 50, limits,
                               {{"engine", name}}));
    hashes.insert(RecordingReader(folder / name).content_hash());
  }
  EXPECT_EQ(hashes.size(), 1U);
}

double with_bit_flipped(double value, int bit) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ (std::uint64_t{1} << bit));
}

/// Hash of three frames, after a change to the second.
std::string hash_after(const std::filesystem::path& path,
                       const std::function<void(SceneState&)>& change) {
  std::filesystem::remove(path);
  const Scene scene = make_scene();
  RecordingWriter writer(path, scene, {}, StoredPrecision::kFloat64);
  for (int i = 0; i < 3; ++i) {
    SceneState state = make_state(scene, i, StoredPrecision::kFloat64);
    if (i == 1) {
      change(state);
    }
    writer.add_frame(state);
  }
  return writer.finish();
}

TEST(ContentHash, ChangesWithAnySingleBit) {
  const TemporaryFolder folder;
  const auto path = folder / "a";
  std::set<std::string> hashes{hash_after(path, [](SceneState&) {})};
  std::size_t expected = 1;
  for (const int bit : {0, 1, 31, 51, 52, 63}) {
    hashes.insert(hash_after(path, [&](SceneState& s) {
      s.cloths[1].positions(2, 24) = with_bit_flipped(s.cloths[1].positions(2, 24), bit);
    }));
    hashes.insert(hash_after(path, [&](SceneState& s) {
      s.cloths[0].velocities(0, 0) = with_bit_flipped(s.cloths[0].velocities(0, 0), bit);
    }));
    hashes.insert(hash_after(path, [&](SceneState& s) {
      s.rigids[0].angular_velocity(1) = with_bit_flipped(s.rigids[0].angular_velocity(1), bit);
    }));
    expected += 3;
  }
  hashes.insert(hash_after(path, [](SceneState& s) { s.time = with_bit_flipped(s.time, 0); }));
  EXPECT_EQ(hashes.size(), expected + 1);
}

TEST(ContentHash, ChangesWithScenePrecisionFramesAndBlowUp) {
  const TemporaryFolder folder;
  Scene other = make_scene();
  other.world.gravity.y() = with_bit_flipped(other.world.gravity.y(), 0);
  std::set<std::string> hashes{
      write_sample(folder / "a", make_scene(), StoredPrecision::kFloat64, 3),
      write_sample(folder / "b", other, StoredPrecision::kFloat64, 3),
      write_sample(folder / "c", make_scene(), StoredPrecision::kFloat32, 3),
      write_sample(folder / "d", make_scene(), StoredPrecision::kFloat64, 4),
      hash_after(folder / "e", [](SceneState&) {}),  // the same frames as "a", no blow-up
  };
  EXPECT_EQ(hashes.size(), 5U);
}

}  // namespace
}  // namespace weft::scenes
