#include <weft/playback/video/video_encoder.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using Container = VideoFormat::Container;

Image gray(int width, int height, std::uint8_t value) {
  const std::size_t size = std::size_t{3} * static_cast<std::size_t>(width * height);
  return {width, height, std::vector<std::uint8_t>(size, value)};
}

/// PATH without any program, for one test.
class EmptyPath {
 public:
  EmptyPath() : before_(std::getenv("PATH")) { setenv("PATH", "/no/such/folder", 1); }
  ~EmptyPath() { setenv("PATH", before_.c_str(), 1); }
  EmptyPath(const EmptyPath&) = delete;
  EmptyPath& operator=(const EmptyPath&) = delete;

 private:
  std::string before_;
};

/// Whether tests that need ffmpeg can run.
bool has_ffmpeg() {
  return std::system("ffmpeg -version >/dev/null 2>&1") == 0;
}

TEST(VideoEncoder, SaysThatFfmpegIsMissing) {
  const EmptyPath path;
  EXPECT_THAT(
      [] {
        VideoEncoder({Container::kMp4, 32, 16, 25.0});
      },
      ThrowsMessage<Error>(HasSubstr("ffmpeg cannot be started (No such file or directory), "
                                     "expected it in PATH")));
}

TEST(VideoEncoder, RefusesWhatAContainerDoesNotHave) {
  const auto fault = [](const VideoFormat& format) -> std::string {
    try {
      VideoEncoder encoder(format);
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(fault({Container::kMp4, 33, 16, 25.0}), HasSubstr("33 x 16 pixels, expected even"));
  EXPECT_THAT(fault({Container::kGif, 33, 16, 60.0}), HasSubstr("frame rate = 60 [1/s]"));
  EXPECT_THAT(fault({Container::kMp4, 32, 16, 0.0}), HasSubstr("frame rate = 0 [1/s]"));
  EXPECT_THAT(fault({Container::kMp4, 0, 16, 25.0}), HasSubstr("0 x 16 pixels"));
}

TEST(VideoEncoder, MakesFilesThatAreKnownAsItsOwn) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not here (Debian: ffmpeg)";
  for (const Container container : {Container::kMp4, Container::kGif}) {
    VideoEncoder encoder({container, 64, 32, 25.0});
    // Long enough that the tables at the end of the file are larger than the beginning that is looked at.
    for (int i = 0; i < 600; ++i) encoder.add(gray(64, 32, static_cast<std::uint8_t>(i % 250)));
    const std::string film = encoder.finish();
    const std::string_view beginning = std::string_view(film).substr(0, output::kBeginningBytes);
    EXPECT_EQ(kMp4Kind.recognizes(beginning), container == Container::kMp4);
    EXPECT_EQ(kGifKind.recognizes(beginning), container == Container::kGif);
  }
  EXPECT_FALSE(kMp4Kind.recognizes(std::string("\0\0\0\x20"
                                               "ftypisom",
                                               12) +
                                   "another's"));
}

TEST(VideoEncoder, GivesTheSameBytesAgain) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not here (Debian: ffmpeg)";
  const auto film = [] {
    VideoEncoder encoder({Container::kMp4, 64, 32, 25.0});
    for (int i = 0; i < 20; ++i) encoder.add(gray(64, 32, static_cast<std::uint8_t>(10 * i)));
    return encoder.finish();
  };
  EXPECT_EQ(film(), film());
}

TEST(VideoEncoder, RefusesImagesOfAnotherSizeAndFilmsOfNone) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not here (Debian: ffmpeg)";
  VideoEncoder encoder({Container::kMp4, 64, 32, 25.0});
  EXPECT_THAT([&] { encoder.add(gray(32, 32, 0)); },
              ThrowsMessage<InvalidArgument>(HasSubstr("32 x 32 pixels, expected 64 x 32")));
  EXPECT_THAT([&] { (void)encoder.finish(); },
              ThrowsMessage<InvalidArgument>(HasSubstr("no image")));
}

}  // namespace
}  // namespace weft::scenes
