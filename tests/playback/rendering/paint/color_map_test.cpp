#include <weft/playback/rendering/paint/color_map.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// CIE lightness of a colour, 0 to 100.
double lightness(const Rgb& color) {
  const Eigen::Vector3d light = linear_light(color).cast<double>();
  return 116.0 * std::cbrt(light.dot(Eigen::Vector3d(0.2126, 0.7152, 0.0722))) - 16.0;
}

TEST(ColorMap, LightnessGrowsEvenlyOverOneSidedRanges) {
  const ColorMap map(0.0, 1.0);
  ASSERT_FALSE(map.is_diverging());
  constexpr int kSteps = 16;
  const double mean = (lightness(map.color(1.0)) - lightness(map.color(0.0))) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double step = lightness(map.color((i + 1.0) / kSteps)) -
                        lightness(map.color(static_cast<double>(i) / kSteps));
    // Uniform in CAM02-UCS, whose lightness bends a little against L*: half a mean step.
    EXPECT_NEAR(step, mean, 0.5 * mean) << i;
  }
}

TEST(ColorMap, ZeroIsWhiteAndEqualDistancesLookEquallyStrong) {
  const ColorMap map(-1.0, 4.0);
  ASSERT_TRUE(map.is_diverging());
  EXPECT_EQ(map.color(0.0), (Rgb{240, 239, 235}));
  // The ends' lightness differs by 4, a quarter of the way by 1; one more for 8 bits.
  EXPECT_NEAR(lightness(map.color(-1.0)), lightness(map.color(1.0)), 2.0);
  EXPECT_GT(map.color(-1.0)[2], map.color(-1.0)[0]);
  EXPECT_GT(map.color(1.0)[0], map.color(1.0)[2]);
}

TEST(ColorMap, ValuesOutOfTheRangeGetItsEnds) {
  const ColorMap map(2.0, 3.0);
  EXPECT_EQ(map.color(1.0), map.color(2.0));
  EXPECT_EQ(map.color(9.0), map.color(3.0));
  EXPECT_EQ(map.color(std::numeric_limits<double>::quiet_NaN()), kNoValueColor);
}

TEST(ColorMap, RefusesRangesThatAreNone) {
  EXPECT_THROW(ColorMap(1.0, 0.0), InvalidArgument);
  EXPECT_THROW(ColorMap(0.0, std::numeric_limits<double>::infinity()), InvalidArgument);
  EXPECT_NO_THROW(ColorMap(0.0, 0.0));  // the strain of a scene at rest
}

TEST(ColorMap, EightBitColoursSurviveLinearLight) {
  for (int i = 0; i < 256; ++i) {
    const auto value = static_cast<std::uint8_t>(i);
    const Rgb color = {value, value, value};
    EXPECT_EQ(encode_srgb(linear_light(color)), color);
  }
}

}  // namespace
}  // namespace weft::scenes
