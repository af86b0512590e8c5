#pragma once

#include <memory>
#include <string>

#include <weft/playback/rendering/image.hpp>
#include <weft/scenes/output/file_kind.hpp>

namespace weft::scenes {

struct VideoFormat {
  enum class Container {
    kMp4,  ///< H.264; sizes are even numbers of pixels
    kGif,  ///< 256 colors for each frame; at most 50 frames a second, because delays are whole hundredths of a second
  };
  Container container = Container::kMp4;
  int width = 960;           ///< [pixel]
  int height = 540;          ///< [pixel]
  double frame_rate = 25.0;  ///< [1/s], > 0
};

/// Makes a film of pictures with the program ffmpeg, which runs beside this process and writes into memory: whatever ends this process, no file
/// is left behind.
class VideoEncoder {
 public:
  /// Starts ffmpeg. Throws InvalidArgument for a format that the container does not have, and Error if ffmpeg is not in PATH.
  explicit VideoEncoder(const VideoFormat& format);
  ~VideoEncoder();  ///< ends ffmpeg if it still runs
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// Throws InvalidArgument for an image of another size, and Error with ffmpeg's words if it has given up.
  void add(const Image& image);
  /// The whole file. Throws Error with ffmpeg's words if it fails, and InvalidArgument for a film without an image.
  [[nodiscard]] std::string finish();

 private:
  struct Process;
  [[noreturn]] void fail() const;  ///< with ffmpeg's words

  VideoFormat format_;
  std::unique_ptr<Process> process_;
  int num_images_ = 0;
};

/// An MP4 file, a GIF file that VideoEncoder made.
extern const output::FileKind kMp4Kind;
extern const output::FileKind kGifKind;

}  // namespace weft::scenes
