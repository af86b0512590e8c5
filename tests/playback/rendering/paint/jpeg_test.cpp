#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/image.hpp>

namespace weft::scenes {
namespace {

Image smooth_image() {
  Image image{64, 40, {}};
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (const int value : {3 * column, 5 * row, 40 + 2 * row + column}) {
        image.rgb.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return image;
}

TEST(Jpeg, DecodesToNearlyTheSamePixels) {
  const Image image = smooth_image();
  const Image decoded = decode_image(encode_jpeg(image));
  ASSERT_EQ(decoded.width, image.width);
  ASSERT_EQ(decoded.height, image.height);
  double sum = 0;
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    sum += std::abs(static_cast<double>(decoded.rgb[i]) - static_cast<double>(image.rgb[i]));
  }
  // Levels of 255: the eye sees a difference of about 2 between large areas.
  EXPECT_LT(sum / static_cast<double>(image.rgb.size()), 2.0);
}

TEST(Jpeg, TakesLessRoomAtALowerQualityAndGivesTheSameBytesTwice) {
  EXPECT_LT(encode_jpeg(smooth_image(), 30).size(), encode_jpeg(smooth_image(), 95).size());
  EXPECT_EQ(encode_jpeg(smooth_image()), encode_jpeg(smooth_image()));
}

TEST(Jpeg, RefusesImagesWhoseBytesDoNotFitAndQualitiesThatAreNone) {
  EXPECT_THROW((void)encode_jpeg(Image{}), InvalidArgument);
  EXPECT_THROW((void)encode_jpeg(Image{2, 2, std::vector<std::uint8_t>(11)}), InvalidArgument);
  EXPECT_THROW((void)encode_jpeg(smooth_image(), 0), InvalidArgument);
  EXPECT_THROW((void)encode_jpeg(smooth_image(), 101), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
