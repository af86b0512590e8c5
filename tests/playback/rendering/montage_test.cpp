#include <weft/playback/rendering/montage.hpp>

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/paint/text.hpp>

#include "tests/playback/rendering/small_scene.hpp"

namespace weft::scenes {
namespace {

Image filled(int width, int height, std::uint8_t value) {
  return {width, height,
          std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), value)};
}

TEST(Filmstrip, PutsPicturesInTheirOrderIntoRows) {
  const Image page = filmstrip({filled(40, 20, 10), filled(40, 20, 20), filled(40, 20, 30)}, 2);
  ASSERT_EQ(page.width, 82);  // a gap of 2 pixels
  ASSERT_EQ(page.height, 42);
  EXPECT_EQ(pixel(page, 20, 10)[0], 10);
  EXPECT_EQ(pixel(page, 62, 10)[0], 20);
  EXPECT_EQ(pixel(page, 20, 32)[0], 30);
  EXPECT_EQ(pixel(page, 62, 32)[0], 255);
}

TEST(Label, IsSeenOnLightAndOnDarkPictures) {
  for (const int ground : {20, 230}) {
    Image image = filled(200, 100, static_cast<std::uint8_t>(ground));
    draw_label(image, "t = 1 s");
    int farthest = 0;
    for (const std::uint8_t value : image.rgb) {
      farthest = std::max(farthest, std::abs(static_cast<int>(value) - ground));
    }
    EXPECT_GT(farthest, 150) << ground;
  }
}

TEST(Filmstrip, RefusesWhatMakesNoStrip) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  EXPECT_THAT([] { (void)filmstrip({}, 2); }, ThrowsMessage<InvalidArgument>(HasSubstr("no pict")));
  EXPECT_THAT([] { (void)filmstrip({filled(4, 4, 0)}, 0); },
              ThrowsMessage<InvalidArgument>(HasSubstr("columns = 0")));
  EXPECT_THAT(
      [] {
        (void)filmstrip({filled(4, 4, 0), filled(5, 4, 0)}, 2);
      },
      ThrowsMessage<InvalidArgument>(HasSubstr("5 x 4 pixels, expected 4 x 4")));
}

TEST(ContactSheet, WritesBelowEachPicture) {
  const Image page = contact_sheet({{filled(480, 270, 128), "name", "some words below"}}, 4);
  int dark_below = 0;
  for (int row = 302; row < page.height; ++row) {
    for (int column = 0; column < page.width; ++column) {
      dark_below += pixel(page, column, row)[0] < 120 ? 1 : 0;
    }
  }
  EXPECT_GT(dark_below, 20);
  EXPECT_EQ(pixel(page, page.width / 2, 50)[0], 128);
}

TEST(WrapText, KeepsEveryLineWithinItsWidth) {
  const std::string text = "a carpet that is led along a spline by its front edge and banks";
  constexpr float kWidth = 160.0f;
  const auto lines = wrap_text(text, kWidth, 12.0f, 10);
  std::string joined;
  for (const std::string& line : lines) {
    EXPECT_LE(text_width(line, 12.0f), kWidth) << line;
    joined += (joined.empty() ? "" : " ") + line;
  }
  EXPECT_EQ(joined, text);
  const auto two = wrap_text(text, kWidth, 12.0f, 2);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_TRUE(two[1].ends_with("..."));
  EXPECT_LE(text_width(two[1], 12.0f), kWidth);
}

}  // namespace
}  // namespace weft::scenes
