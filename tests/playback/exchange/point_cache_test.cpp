#include <weft/playback/exchange/point_cache.hpp>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

PointCache small_cache() {
  PointCache cache;
  cache.first_frame = 3.0f;
  cache.frame_step = 0.5f;
  for (int s = 0; s < 4; ++s) cache.samples.push_back(Eigen::Matrix3Xf::Random(3, 5));
  return cache;
}

std::string cache_fault(const std::string& bytes) {
  try {
    (void)decode_point_cache(bytes, "a.pc2");
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(PointCache, HasTheLayoutOfTheFormat) {
  const std::string bytes = encode_point_cache(small_cache());
  EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(bytes.substr(12, 8), std::string("\1\0\0\0\5\0\0\0", 8)) << "version, points";
  EXPECT_EQ(bytes.size(), 32U + 4 * 5 * 12);
}

TEST(PointCache, ReadsBackTheSameBits) {
  const PointCache cache = small_cache();
  const PointCache again = decode_point_cache(encode_point_cache(cache), "a.pc2");
  EXPECT_EQ(again.first_frame, 3.0f);
  EXPECT_EQ(again.frame_step, 0.5f);
  ASSERT_EQ(again.samples.size(), 4U);
  for (std::size_t s = 0; s < 4; ++s) EXPECT_EQ(again.samples[s], cache.samples[s]);
}

TEST(PointCache, RefusesDamagedBytesWithTheReason) {
  const std::string bytes = encode_point_cache(small_cache());
  EXPECT_EQ(cache_fault("ply"),
            "a.pc2: not a PC2 point cache, expected it to begin with POINTCACHE2");
  EXPECT_EQ(cache_fault(bytes.substr(0, 20)),
            "a.pc2: is cut off, 20 bytes, expected a header of 32");
  EXPECT_EQ(cache_fault(bytes.substr(0, 100)),
            "a.pc2: has 100 bytes, expected 272 for 5 points and 4 samples");
  std::string huge = bytes;
  huge.replace(16, 4, "\xff\xff\xff\x7f");
  EXPECT_NE(cache_fault(huge).find("expected 103079215088 for 2147483647 points"),
            std::string::npos)
      << cache_fault(huge);
  std::string negative = bytes;
  negative.replace(28, 4, "\xff\xff\xff\xff");
  EXPECT_NE(cache_fault(negative).find("-1 samples"), std::string::npos);
  std::string version = bytes;
  version[12] = 2;
  EXPECT_EQ(cache_fault(version), "a.pc2: PC2 version = 2, expected 1");
}

TEST(PointCache, RefusesSamplesOfSeveralSizes) {
  PointCache cache = small_cache();
  cache.samples.push_back(Eigen::Matrix3Xf::Zero(3, 6));
  EXPECT_THROW((void)encode_point_cache(cache), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
