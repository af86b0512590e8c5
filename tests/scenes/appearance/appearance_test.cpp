#include <weft/scenes/appearance/appearance.hpp>

#include <png.h>
#include <turbojpeg.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/appearance/image_file.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

using ::testing::HasSubstr;

/// A scene with these lines in its cloth (from line 10 on) and in its ball.
std::string scene_text(const std::string& cloth, const std::string& ball = "") {
  return R"(schema = "weft-scene/1"
name = "small"
[world]
time_step = "1/100 s"
duration = "1 s"
[[cloth]]
name = "cloth"
grid = { nodes = [3, 3], size = ["1 m", "1 m"] }
mass = "1 kg"
)" + cloth +
         R"(
[[collider]]
name = "ball"
shape = "sphere"
radius = "1 m"
)" + ball;
}

/// PNG of one row of pixels.
std::string png_row(const std::vector<std::uint8_t>& rgb) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(rgb.size() / 3);
  png.height = 1;
  png.format = PNG_FORMAT_RGB;
  std::string bytes(4096, '\0');
  png_alloc_size_t size = bytes.size();
  EXPECT_NE(png_image_write_to_memory(&png, bytes.data(), &size, 0, rgb.data(), 0, nullptr), 0);
  bytes.resize(size);
  return bytes;
}

FileSource source_of(const std::string& name, const std::string& bytes) {
  return
      [=](const std::string& asked) { return asked == name ? std::optional(bytes) : std::nullopt; };
}

std::string error_of(const std::string& text, const FileSource& files = {}) {
  try {
    (void)read_scene_text(text, "test.toml", files);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Appearance, ColoursAreNamesOrHex) {
  EXPECT_EQ(parse_color("#1002Ff"), (Rgb{16, 2, 255}));
  EXPECT_EQ(format_color({16, 2, 255}), "#1002ff");
  EXPECT_EQ(parse_color("#1002f"), std::nullopt);
  EXPECT_EQ(parse_color("#1002fg"), std::nullopt);
  for (const std::string_view name : color_names()) EXPECT_TRUE(parse_color(name)) << name;
}

TEST(Appearance, OfASceneReadsBackAsItWasWritten) {
  const std::string text = scene_text(
      "color = \"red\"\nback_color = \"#010203\"\npattern_color = \"cream\"\ntexture = \"tartan\"\n"
      "texture_repeat = [2, 0.5]\nsmooth = false\nvisible = false",
      "texture = \"eyeball\"\nvisible = false\n");
  const Scene scene = read_scene_text(text, "test.toml");
  const Appearance& cloth = scene.cloths[0].appearance;
  EXPECT_EQ(cloth.color, parse_color("red"));
  EXPECT_EQ(cloth.back_color, (Rgb{1, 2, 3}));
  EXPECT_EQ(cloth.pattern, Pattern::kTartan);
  EXPECT_EQ(cloth.texture_repeat[1], 0.5);
  EXPECT_FALSE(cloth.smooth);
  EXPECT_FALSE(scene.colliders[0].appearance.visible);
  const std::string written = write_scene(scene);
  EXPECT_EQ(write_scene(read_scene_text(written, "written.toml")), written);
  EXPECT_THAT(written, HasSubstr("texture = \"tartan\""));
  EXPECT_THAT(written, HasSubstr("pattern_color = "));
}

TEST(Appearance, OfNoSceneLeavesItsTextAsItWas) {
  const std::string written = write_scene(read_scene_text(scene_text(""), "test.toml"));
  for (const char* key : {"color", "texture", "smooth", "visible", "follow", "poster_time"}) {
    EXPECT_EQ(written.find(key), std::string::npos) << key;
  }
}

TEST(Appearance, CameraKeysReadBack) {
  const std::string text =
      scene_text("") + "[camera]\nfollow = \"ball\"\nposter_time = \"0.5 s\"\n";
  const Scene scene = read_scene_text(text, "test.toml");
  EXPECT_EQ(scene.camera.follow, "ball");
  EXPECT_EQ(scene.camera.poster_time, 0.5);
  const std::string written = write_scene(scene);
  EXPECT_EQ(write_scene(read_scene_text(written, "written.toml")), written);
  EXPECT_THAT(error_of(scene_text("") + "[camera]\nfollow = \"nobody\"\n"),
              HasSubstr("no body has this name"));
}

TEST(Appearance, MistakesNameTheirPlace) {
  EXPECT_THAT(error_of(scene_text("color = \"rde\"")), HasSubstr("test.toml:10:9: "));
  EXPECT_THAT(error_of(scene_text("color = \"rde\"")), HasSubstr("did you mean 'red'?"));
  EXPECT_THAT(error_of(scene_text("texture = \"cheks\"")), HasSubstr("did you mean 'checks'?"));
  EXPECT_THAT(error_of(scene_text("texture = \"/a.png\"")), HasSubstr("is an absolute path"));
  EXPECT_THAT(error_of(scene_text("texture_repeat = [1, 0]")), HasSubstr("> 0"));
  EXPECT_THAT(error_of(scene_text("texture_repeat = [1, 1e9]")), HasSubstr("at most 1000"));
  EXPECT_THAT(error_of(scene_text("smooth = 1")), HasSubstr("expected true or false"));
  EXPECT_THAT(error_of(scene_text("", "back_color = \"red\"\n")), HasSubstr("unknown key"));
}

TEST(Appearance, PicturesAreReadBesideTheSceneFile) {
  const std::string png = png_row({255, 0, 0, 0, 0, 255});
  const auto folder =
      std::filesystem::temp_directory_path() / ("weft_appearance_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder / "pictures");
  std::ofstream(folder / "pictures/a.png", std::ios::binary) << png;
  std::ofstream(folder / "scene.toml")
      << scene_text("texture = \"pictures/a.png\"", "texture = \"pictures/a.png\"\n");
  const Scene scene = read_scene_file(folder / "scene.toml");
  std::filesystem::remove_all(folder);
  ASSERT_EQ(scene.files.size(), 1U);  // once, though two bodies wear it
  EXPECT_EQ(scene.files[0].bytes, png);
  const std::string written = write_scene(scene);
  EXPECT_EQ(write_scene(read_scene_text(written, "written.toml", files_of(scene))), written);
}

TEST(Appearance, PicturesThatCannotBeReadAreRefused) {
  const std::string text = scene_text("texture = \"a.png\"");
  const std::string png = png_row({1, 2, 3, 4, 5, 6, 7, 8, 9});
  EXPECT_EQ(error_of(text, source_of("a.png", png)), "no error");
  EXPECT_THAT(error_of(text), HasSubstr("test.toml:10:11: "));
  EXPECT_THAT(error_of(text), HasSubstr("no such file"));
  EXPECT_THAT(error_of(text, source_of("a.png", "GIF89a")), HasSubstr("neither a PNG nor a JPEG"));
  EXPECT_THAT(error_of(text, source_of("a.png", "")), HasSubstr("neither a PNG nor a JPEG"));
  for (const std::size_t size : {png.size() / 2, png.size() - 20}) {
    EXPECT_THAT(error_of(text, source_of("a.png", png.substr(0, size))),
                HasSubstr("no readable PNG"));
  }
  EXPECT_THAT(error_of(text, source_of("a.png", "\xff\xd8\xff\xe0 no more")),
              HasSubstr("no readable JPEG"));
}

std::string decoding_error(const std::string& bytes) {
  try {
    (void)decode_image(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// A few bytes may say that a picture has 200 MB, or that its pixels are to be gone over for an hour.
TEST(Appearance, ThePixelsOfAPictureAreCountedBeforeTheyAreDecoded) {
  std::string png = png_row({1, 2, 3});
  const auto set_size = [&](char high_width, char high_height) {  // in units of 256 pixels
    png[18] = high_width;
    png[22] = high_height;
    png[19] = png[23] = 0;
    // The checksum of the header's 17 bytes.
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(png.data()) + 12, 17);
    for (int i = 0; i < 4; ++i) png[29 + i] = static_cast<char>(sum >> (24 - 8 * i) & 255U);
  };
  set_size(32, 32);
  EXPECT_THAT(decoding_error(png), HasSubstr("pixels, expected at most 33554432 in all"));
  set_size(33, 1);
  EXPECT_THAT(decoding_error(png), HasSubstr("expected at most 8192 x 8192"));
}

TEST(Appearance, AJpegOfTooManyScansIsRefused) {
  const std::vector<unsigned char> pixels(3 * 16 * 16, 100);
  tjhandle handle = tjInitCompress();
  unsigned char* made = nullptr;
  unsigned long size = 0;
  ASSERT_EQ(tjCompress2(handle, pixels.data(), 16, 0, 16, TJPF_RGB, &made, &size, TJSAMP_444, 90,
                        TJFLAG_PROGRESSIVE),
            0);
  const std::string whole(reinterpret_cast<const char*>(made), size);
  tjFree(made);
  tjDestroy(handle);
  EXPECT_EQ(decoding_error(whole), "no error");
  const std::size_t scan = whole.rfind("\xff\xda");
  const std::string last = whole.substr(scan, whole.size() - 2 - scan);
  std::string many = whole.substr(0, whole.size() - 2);
  for (int i = 0; i < 100; ++i) many += last;
  EXPECT_THAT(decoding_error(many + "\xff\xd9"), HasSubstr("has over 64 scans"));
}

TEST(Appearance, PixelsOfAPictureComeInTheirOrder) {
  const std::vector<std::uint8_t> rgb = {1, 2, 3, 250, 0, 9};
  const Image image = decode_image(png_row(rgb));
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 1);
  EXPECT_EQ(image.rgb, rgb);
}

/// A scene file with a picture beside it, black on the left and white on the right.
class Mask : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("weft_mask_" + std::to_string(getpid()));
    std::filesystem::create_directory(folder_);
    std::ofstream(folder_ / "mask.png", std::ios::binary) << png_row({0, 0, 0, 255, 255, 255});
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Scene read(const std::string& pin) const {
    std::ofstream(folder_ / "scene.toml") << scene_text("pin = [" + pin + "]");
    return read_scene_file(folder_ / "scene.toml");
  }
  [[nodiscard]] std::string error(const std::string& pin) const {
    try {
      (void)read(pin);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(Mask, PinsTheNodesAtBrightPlaces) {
  const Scene scene = read(R"({ texture = "mask.png" })");
  EXPECT_EQ(make_mesh(scene.cloths[0]).pinned, (std::vector<int>{1, 2, 4, 5, 7, 8}));
  // A recording needs no picture: the nodes are written out.
  const Scene again = read_scene_text(write_scene(scene), "again");
  EXPECT_EQ(make_mesh(again.cloths[0]).pinned, make_mesh(scene.cloths[0]).pinned);
}

TEST_F(Mask, SaysWhatIsWrong) {
  EXPECT_THAT(error(R"({ texture = "musk.png" })"),
              HasSubstr("scene.toml:10:20: cloth.pin[0].texture"));
  EXPECT_THAT(error(R"({ texture = "mask.png", above = 1 })"), HasSubstr("marks no node"));
  EXPECT_THAT(error(R"({ texture = "scene.toml" })"), HasSubstr(".png or .jpg"));
}

}  // namespace
}  // namespace weft::scenes
