#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/image.hpp>

namespace weft::scenes {
namespace {

namespace fs = std::filesystem;

Image gradient_image() {
  Image image{37, 21, {}};
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (const int value : {6 * column, 12 * row, 5 * (row ^ column)}) {
        image.rgb.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return image;
}

Image decode(const std::string& bytes) {
  png_image reader{};
  reader.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&reader, bytes.data(), bytes.size()), 0);
  reader.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(reader.width), static_cast<int>(reader.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(reader));
  EXPECT_NE(png_image_finish_read(&reader, nullptr, image.rgb.data(), 0, nullptr), 0);
  return image;
}

struct PngFileTest : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / "weft_png_test";
  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
};

TEST(Png, DecodesToTheSamePixels) {
  const Image image = gradient_image();
  const Image decoded = decode(encode_png(image));
  EXPECT_EQ(decoded.width, image.width);
  EXPECT_EQ(decoded.height, image.height);
  EXPECT_EQ(decoded.rgb, image.rgb);
}

TEST(Png, CarriesACommentAndNoDate) {
  const std::string bytes = encode_png(gradient_image());
  EXPECT_THAT(bytes, testing::HasSubstr("tEXtComment"));
  EXPECT_THAT(bytes, testing::Not(testing::HasSubstr("tIME")));
  EXPECT_EQ(bytes, encode_png(gradient_image()));
}

TEST(Png, RefusesImagesWhoseBytesDoNotFit) {
  EXPECT_THROW((void)encode_png(Image{}), InvalidArgument);
  EXPECT_THROW((void)encode_png(Image{2, 2, std::vector<std::uint8_t>(11)}), InvalidArgument);
}

TEST_F(PngFileTest, FileHoldsTheEncodedBytesAndNothingElseStays) {
  const fs::path path = folder / "picture.png";
  write_png(path, gradient_image());
  write_png(path, gradient_image());  // replaces
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_EQ(bytes, encode_png(gradient_image()));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(PngFileTest, FailureNamesTheFileAndLeavesNothing) {
  const fs::path missing = folder / "no_such_folder" / "picture.png";
  EXPECT_THAT([&] { write_png(missing, gradient_image()); },
              testing::ThrowsMessage<Error>(testing::HasSubstr(missing.string())));
  fs::create_directories(folder / "taken.png" / "child");  // a folder cannot be replaced by a file
  EXPECT_THAT([&] { write_png(folder / "taken.png", gradient_image()); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("taken.png")));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace weft::scenes
