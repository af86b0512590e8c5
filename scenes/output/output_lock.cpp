#include <weft/scenes/output/output_lock.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::output {
namespace {

constexpr std::string_view kText = "weft writes here, process ";

/// What the file says; empty if nothing yet.
std::string read_text(int file) {
  std::array<char, 256> bytes{};
  const ssize_t count = pread(file, bytes.data(), bytes.size(), 0);
  return {bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
}

void check_is_lock(int file, const std::filesystem::path& path) {
  struct stat status {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
    const std::string text = read_text(file);
    if (text.empty() || text.starts_with(kText)) return;
  }
  throw Error(path.string() + ": exists and is not a lock of Weft's, expected another output");
}

[[noreturn]] void throw_held(int file, const std::filesystem::path& output) {
  std::string text = read_text(file);
  text.resize(std::min(text.find('\n'), text.size()));
  const std::string holder = text.starts_with(kText) ? text.substr(kText.size()) : "unknown";
  if (holder == std::to_string(getpid())) {
    throw Error(output.string() + ": named for two outputs, expected a name for each");
  }
  throw Error(
      fmt::format("{}: is being written by another run (process {}), expected another output "
                  "or to wait for its end",
                  output.string(), holder));
}

bool is_still_named(int file, const std::filesystem::path& path) {
  struct stat opened {};
  struct stat named {};
  return fstat(file, &opened) == 0 && lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

int open_lock(const std::filesystem::path& path, const std::filesystem::path& output) {
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (file >= 0) return file;
  if (errno == ELOOP || errno == EISDIR || errno == ENXIO) {
    throw Error(path.string() + ": exists and is not a lock of Weft's, expected another output");
  }
  throw Error(fmt::format("{}: cannot be written: {}", output.string(), std::strerror(errno)));
}

}  // namespace

OutputLock::OutputLock(std::filesystem::path file, const std::filesystem::path& output,
                       AtEnd at_end)
    : file_(std::move(file)), at_end_(at_end) {
  while (descriptor_ < 0) {
    const int opened = open_lock(file_, output);
    try {
      check_is_lock(opened, file_);
      if (flock(opened, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) throw_held(opened, output);
        throw Error(fmt::format("{}: cannot be locked: {}", file_.string(), std::strerror(errno)));
      }
      // The holder before may have removed it between the opening and the lock.
      if (is_still_named(opened, file_)) {
        descriptor_ = opened;
      } else {
        close(opened);
      }
    } catch (...) {
      close(opened);
      throw;
    }
  }
  const std::string text = fmt::format("{}{}\n", kText, getpid());
  // The text is for people and may be lost on a full disk; the lock itself is not in it.
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) < 0)
    return;
}

OutputLock::~OutputLock() {
  if (at_end_ == AtEnd::kRemove) unlink(file_.c_str());  // before the lock ends: it is ours
  close(descriptor_);
}

}  // namespace weft::output
