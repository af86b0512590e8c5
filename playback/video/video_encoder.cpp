#include <weft/playback/video/video_encoder.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <weft/core/error.hpp>

extern char** environ;

namespace weft::scenes {
namespace {

/// In every film, and what it is known by.
constexpr std::string_view kComment = "Rendered by Weft";

/// ffmpeg writes into this descriptor of its own, which it opens by name, because an MP4 file is not written from its beginning to its end.
constexpr int kOutputDescriptor = 3;
constexpr const char* kOutputName = "/proc/self/fd/3";

constexpr double kLargestGifRate = 50.0;  // [1/s]

bool begins_as_mp4(std::string_view beginning) {
  return beginning.substr(0, 16).find("ftyp") == 4 &&
         beginning.find(kComment) != std::string_view::npos;
}

bool begins_as_gif(std::string_view beginning) {
  return beginning.starts_with("GIF89a") && beginning.find(kComment) != std::string_view::npos;
}

void check(const VideoFormat& format) {
  if (format.width < 2 || format.height < 2) {
    throw InvalidArgument(
        fmt::format("video: {} x {} pixels, expected at least 2 x 2", format.width, format.height));
  }
  if (!(format.frame_rate > 0.0) || !std::isfinite(format.frame_rate)) {
    throw InvalidArgument(
        fmt::format("video: frame rate = {} [1/s], expected > 0", format.frame_rate));
  }
  const bool is_gif = format.container == VideoFormat::Container::kGif;
  if (is_gif && format.frame_rate > kLargestGifRate) {
    throw InvalidArgument(
        fmt::format("video: frame rate = {:.6g} [1/s], expected at most {} of a GIF",
                    format.frame_rate, kLargestGifRate));
  }
  if (!is_gif && (format.width % 2 != 0 || format.height % 2 != 0)) {
    throw InvalidArgument(fmt::format("video: {} x {} pixels, expected even numbers of an MP4",
                                      format.width, format.height));
  }
}

std::vector<std::string> arguments_of(const VideoFormat& format) {
  std::vector<std::string> words = {"ffmpeg",
                                    "-hide_banner",
                                    "-loglevel",
                                    "error",
                                    "-nostdin",
                                    "-f",
                                    "rawvideo",
                                    "-pixel_format",
                                    "rgb24",
                                    "-video_size",
                                    fmt::format("{}x{}", format.width, format.height),
                                    "-framerate",
                                    fmt::format("{}", format.frame_rate),
                                    "-i",
                                    "pipe:0",
                                    "-fflags",
                                    "+bitexact",
                                    "-flags:v",
                                    "+bitexact"};
  const auto add = [&](std::initializer_list<const char*> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  if (format.container == VideoFormat::Container::kGif) {
    // A palette for each frame needs no memory for all of them, and an ordered dither does not flicker.
    const std::string palette =
        "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=bayer:"
        "bayer_scale=4";
    add({"-filter_complex", palette.c_str(), "-loop", "0", "-f", "gif"});
  } else {
    // yuv420p and the limited range of BT.709 are what every player has. The message in the stream's first bytes is what a film of Weft is known by;
    // the identifier before it is a random one that only Weft uses.
    add({"-c:v",
         "libx264",
         "-preset",
         "medium",
         "-crf",
         "18",
         "-vf",
         "scale=out_color_matrix=bt709:out_range=tv",
         "-pix_fmt",
         "yuv420p",
         "-colorspace",
         "bt709",
         "-color_primaries",
         "bt709",
         "-color_trc",
         "bt709",
         "-bsf:v",
         "h264_metadata=sei_user_data=5e9b1c0a-47d2-4c3f-9a86-2f1d7b60c4e8+Rendered by Weft",
         "-f",
         "mp4"});
  }
  add({"-y", kOutputName});
  return words;
}

/// The bytes of a file in memory.
std::string content(int descriptor) {
  std::string bytes(static_cast<std::size_t>(lseek(descriptor, 0, SEEK_END)), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        pread(descriptor, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (count <= 0)
      throw Error(fmt::format("video: cannot be read back: {}", std::strerror(errno)));
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

/// A comment after the colors that all frames share, where a GIF may have one.
std::string with_comment(std::string gif) {
  constexpr std::size_t kHeader = 13;  // [byte]
  constexpr unsigned kHasColors = 0x80;
  if (gif.size() < kHeader) throw Error("video: ffmpeg has made no whole GIF");
  const auto flags = static_cast<unsigned char>(gif[10]);
  const std::size_t colors = (flags & kHasColors) != 0 ? std::size_t{3} << ((flags & 7U) + 1U) : 0;
  const std::string comment = std::string("!\xfe") + static_cast<char>(kComment.size()) +
                              std::string(kComment) + std::string(1, '\0');
  return gif.insert(kHeader + colors, comment);
}

int memory_file(const char* name) {
  const int file = memfd_create(name, MFD_CLOEXEC);
  if (file < 0) throw Error(fmt::format("video: no memory for it: {}", std::strerror(errno)));
  return file;
}

}  // namespace

/// ffmpeg and what connects it.
struct VideoEncoder::Process {
  Process() : output(memory_file("weft-video")), messages(memory_file("weft-ffmpeg-messages")) {}
  ~Process() {
    if (input >= 0) close(input);
    if (id > 0) {
      kill(id, SIGKILL);
      (void)wait();
    }
    close(output);
    close(messages);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void start(const std::vector<std::string>& words);
  void close_input() { close(std::exchange(input, -1)); }
  /// Its exit status.
  int wait() {
    int status = 0;
    while (waitpid(id, &status, 0) < 0 && errno == EINTR) {
    }
    id = -1;
    return status;
  }

  int output;
  int messages;
  int input = -1;
  pid_t id = -1;
};

void VideoEncoder::Process::start(const std::vector<std::string>& words) {
  // A socket and no pipe: writing to one whose reader has gone can be told not to raise a signal.
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw Error(fmt::format("video: no connection to ffmpeg: {}", std::strerror(errno)));
  }
  input = ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, kOutputDescriptor);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int reason =
      posix_spawnp(&id, words.front().c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (reason == 0) return;
  id = -1;
  throw Error(fmt::format(
      "video: ffmpeg cannot be started ({}), expected it in PATH (Debian: package ffmpeg)",
      std::strerror(reason)));
}

const output::FileKind kMp4Kind{"an MP4 film", begins_as_mp4};
const output::FileKind kGifKind{"a GIF film", begins_as_gif};

VideoEncoder::VideoEncoder(const VideoFormat& format) : format_(format) {
  check(format);
  process_ = std::make_unique<Process>();
  process_->start(arguments_of(format));
}

VideoEncoder::~VideoEncoder() = default;

void VideoEncoder::add(const Image& image) {
  if (image.width != format_.width || image.height != format_.height) {
    throw InvalidArgument(fmt::format("video: an image has {} x {} pixels, expected {} x {}",
                                      image.width, image.height, format_.width, format_.height));
  }
  std::size_t done = 0;
  while (done < image.rgb.size()) {
    const ssize_t count =
        send(process_->input, image.rgb.data() + done, image.rgb.size() - done, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      process_->close_input();
      (void)process_->wait();
      fail();
    }
    done += static_cast<std::size_t>(count);
  }
  ++num_images_;
}

void VideoEncoder::fail() const {
  std::string said = content(process_->messages);
  for (char& c : said) c = c == '\n' ? ' ' : c;
  throw Error("video: ffmpeg has failed: " + (said.empty() ? "it does not say why" : said));
}

std::string VideoEncoder::finish() {
  if (num_images_ == 0) throw InvalidArgument("video: no image, expected at least one");
  process_->close_input();
  if (process_->wait() != 0) fail();
  const std::string bytes = content(process_->output);
  return format_.container == VideoFormat::Container::kGif ? with_comment(bytes) : bytes;
}

}  // namespace weft::scenes
