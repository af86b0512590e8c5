#include <weft/playback/exchange/import/shape_sequence.hpp>

#include <fstream>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/exchange/point_cache.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

constexpr const char* kTriangle = "v 1 2 3\nv 2 2 3\nv 1 3 3\nf 1 2 3\n";

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string cache_bytes() {
  PointCache cache;
  cache.frame_step = 2.0f;
  for (const float shift : {0.0f, 0.5f}) {
    Eigen::Matrix3Xf sample(3, 3);
    sample << 1, 2, 1, 2, 2, 3, 3, 3, 3;
    cache.samples.push_back(sample.array() + shift);
  }
  return encode_point_cache(cache);
}

template <class Read>
std::string fault_of(const Read& read) {
  try {
    (void)read();
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(PointCacheSequence, TakesAFileAsTheExportWritesIt) {
  const samples::TemporaryFolder folder;
  put(folder / "cloth.pc2", cache_bytes());
  const ShapeSequence sequence = read_point_cache_sequence(folder / "cloth.pc2", {});
  ASSERT_EQ(sequence.samples.size(), 2U);
  EXPECT_EQ(sequence.samples[1].col(1), Vector3<double>(2.5, 2.5, 3.5));
  EXPECT_EQ(sequence.frames_per_sample, 2.0);
  EXPECT_EQ(sequence.precision, StoredPrecision::kFloat32);
  EXPECT_TRUE(sequence.faces.empty());
}

TEST(PointCacheSequence, TurnsZUpAndScalesToMeters) {
  const samples::TemporaryFolder folder;
  put(folder / "cloth.pc2", cache_bytes());
  const ShapeSequence sequence =
      read_point_cache_sequence(folder / "cloth.pc2", {.is_z_up = true, .length_unit = 0.01});
  // Blender's (1, 2, 3): 3 up, 2 away from the viewer, who looks along -z here.
  EXPECT_LT((sequence.samples[0].col(0) - Vector3<double>(0.01, 0.03, -0.02)).norm(), 1e-15);
}

TEST(PointCacheSequence, TakesTheFacesBesideIt) {
  const samples::TemporaryFolder folder;
  put(folder / "cloth.pc2", cache_bytes());
  put(folder / "cloth.obj", kTriangle);
  const ShapeSequence sequence = read_point_cache_sequence(folder / "cloth.pc2", {});
  EXPECT_EQ(sequence.faces, (std::vector<std::vector<int>>{{0, 1, 2}}));
  put(folder / "cloth.obj", std::string("v 0 0 0\n") + kTriangle);
  EXPECT_TRUE(has(fault_of([&] { return read_point_cache_sequence(folder / "cloth.pc2", {}); }),
                  "cloth.pc2: has 3 points, expected 4 as "));
}

TEST(PointCacheSequence, RefusesPlacesThatAreNotFinite) {
  const samples::TemporaryFolder folder;
  PointCache cache;
  cache.samples.assign(2, Eigen::Matrix3Xf::Zero(3, 3));
  cache.samples[1](2, 1) = std::numeric_limits<float>::infinity();
  put(folder / "cloth.pc2", encode_point_cache(cache));
  EXPECT_TRUE(has(fault_of([&] { return read_point_cache_sequence(folder / "cloth.pc2", {}); }),
                  "sample 1: position of point 1 is not finite"));
}

TEST(ObjSequence, IsInTheOrderOfTheFramesAndNotOfTheNames) {
  const samples::TemporaryFolder folder;
  put(folder / "cloth_10.obj", "v 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3\n");
  put(folder / "cloth_9.obj", kTriangle);
  const ShapeSequence sequence = read_obj_sequence(folder.path(), {});
  ASSERT_EQ(sequence.samples.size(), 2U);
  EXPECT_EQ(sequence.samples[0].col(0), Vector3<double>(1, 2, 3));
  EXPECT_EQ(sequence.samples[1].col(2), Vector3<double>(3, 0, 0));
  EXPECT_EQ(sequence.precision, StoredPrecision::kFloat64);
  EXPECT_EQ(sequence.frames_per_sample, 1.0);
}

TEST(ObjSequence, TakesEverySecondFrame) {
  const samples::TemporaryFolder folder;
  for (const char* name : {"a_0.obj", "a_2.obj", "a_4.obj", "b_1.obj"})
    put(folder / name, kTriangle);
  const ShapeSequence sequence = read_obj_sequence(folder / "a_*.obj", {});
  EXPECT_EQ(sequence.samples.size(), 3U);
  EXPECT_EQ(sequence.frames_per_sample, 2.0);
}

TEST(ObjSequence, RefusesWhatIsNoSequenceOfOneBody) {
  const samples::TemporaryFolder folder;
  const auto fault = [&](const std::string& place = "") {
    return fault_of(
        [&] { return read_obj_sequence(place.empty() ? folder.path() : folder / place, {}); });
  };
  put(folder / "a_1.obj", kTriangle);
  EXPECT_TRUE(has(fault(), "1 OBJ files, expected one for each frame and at least two"));
  EXPECT_TRUE(has(fault("gone"), "gone: cannot be read as a folder: "));
  put(folder / "a_2.obj", kTriangle);
  put(folder / "a_4.obj", kTriangle);
  EXPECT_TRUE(has(fault(), "a_4.obj: is frame 4 and comes after frame 2, expected frame 3"));
  put(folder / "b_2.obj", kTriangle);
  EXPECT_TRUE(has(fault(), "b_2.obj: is frame 2 as "));
  put(folder / "cloth.obj", kTriangle);
  EXPECT_TRUE(has(fault("c*.obj"), "cloth.obj: has no number of a frame in its name"));
  put(folder / "a_2.obj", "v 1 2 3\nv 2 2 3\nv 1 3 3\nf 1 3 2\n");
  EXPECT_TRUE(has(fault("a_*.obj"), "a_4.obj: is frame 4")) << "the numbers come first";
  put(folder / "a_3.obj", kTriangle);
  EXPECT_TRUE(has(fault("a_*.obj"), "a_2.obj: has 3 points and 1 faces, expected the 3 points"));
}

}  // namespace
}  // namespace weft::scenes
