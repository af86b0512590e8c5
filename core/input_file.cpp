#include <weft/core/input_file.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>

#include <weft/core/error.hpp>

namespace weft {
namespace {

/// What is read in one piece: a file that shrinks or grows meanwhile costs one piece at most.
constexpr std::size_t kPieceSize = std::size_t{1} << 20U;

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int more_flags)
      // Without O_NONBLOCK, opening a pipe waits for its writer; O_NOCTTY keeps a terminal from
      // becoming the process's own.
      : number_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY | more_flags)) {
    if (number_ >= 0) return;
    if (errno == ENOENT || errno == ENOTDIR) throw InvalidArgument("no such file");
    throw InvalidArgument("cannot be opened: " + std::string(std::strerror(errno)));
  }
  ~Descriptor() { close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Its size [bytes] if it is a regular file, and an error if it is not.
  [[nodiscard]] std::uintmax_t regular_size() const {
    struct stat status {};
    if (fstat(number_, &status) != 0) fail();
    if (S_ISDIR(status.st_mode)) throw InvalidArgument("is a directory, expected a file");
    if (!S_ISREG(status.st_mode)) {
      throw InvalidArgument("is a pipe, a socket or a device, expected a regular file");
    }
    return static_cast<std::uintmax_t>(status.st_size);
  }
  /// Appends the next bytes, at most so many; says whether there were any.
  bool read_more(std::size_t size, std::string& bytes) const {
    const std::size_t begin = bytes.size();
    bytes.resize(begin + size);
    ssize_t count = -1;
    do {
      count = read(number_, bytes.data() + begin, size);
    } while (count < 0 && errno == EINTR);
    if (count < 0) fail();
    bytes.resize(begin + static_cast<std::size_t>(count));
    return count > 0;
  }

 private:
  [[noreturn]] static void fail() {
    throw InvalidArgument("cannot be read: " + std::string(std::strerror(errno)));
  }
  int number_;
};

[[noreturn]] void fail_size(std::uintmax_t size, std::uintmax_t max_size) {
  throw InvalidArgument("has " + std::to_string(size) + " bytes, expected at most " +
                        std::to_string(max_size));
}

std::string read_all(const std::filesystem::path& path, std::uintmax_t max_size, int more_flags) {
  const Descriptor file(path, more_flags);
  const std::uintmax_t size = file.regular_size();
  if (size > max_size) fail_size(size, max_size);
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(size));
  // The file may grow meanwhile: one byte more than may be is enough to see it.
  while (bytes.size() <= max_size &&
         file.read_more(std::min<std::uintmax_t>(kPieceSize, max_size + 1 - bytes.size()), bytes)) {
  }
  if (bytes.size() > max_size) fail_size(bytes.size(), max_size);
  return bytes;
}

void check_name(const std::filesystem::path& name) {
  if (name.is_absolute()) {
    throw InvalidArgument("is an absolute path, expected a file beside the one that names it");
  }
  if (std::find(name.begin(), name.end(), "..") != name.end()) {
    throw InvalidArgument("leads out of the folder, expected a path without '..'");
  }
}

bool is_below(const std::filesystem::path& folder, const std::filesystem::path& path) {
  const auto ends = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return ends.first == folder.end();
}

std::optional<std::string> read_below(const std::filesystem::path& folder, const std::string& name,
                                      std::uintmax_t max_size) {
  // A C function ends a name at its first zero byte, and would open another file.
  if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
  check_name(name);
  std::error_code error;
  const std::filesystem::path root =
      std::filesystem::canonical(folder.empty() ? std::filesystem::path(".") : folder, error);
  if (error) return std::nullopt;
  const std::filesystem::path path = std::filesystem::canonical(root / name, error);
  if (error) return std::nullopt;
  if (!is_below(root, path)) {
    throw InvalidArgument("is a link out of the folder, expected a file in it or below it");
  }
  // The path has no link any more: one that is there now was put there meanwhile.
  return read_all(path, max_size, O_NOFOLLOW);
}

}  // namespace

std::string read_input_file(const std::filesystem::path& path, std::uintmax_t max_size) {
  return read_all(path, max_size, 0);
}

std::string read_input_start(const std::filesystem::path& path, std::size_t size) {
  const Descriptor file(path, 0);
  (void)file.regular_size();
  std::string bytes;
  while (bytes.size() < size && file.read_more(size - bytes.size(), bytes)) {
  }
  return bytes;
}

FileSource files_below(const std::filesystem::path& folder) {
  const auto left = std::make_shared<std::uintmax_t>(kMaxInputSize);
  return [folder, left](const std::string& name) {
    std::optional<std::string> bytes = read_below(folder, name, *left);
    if (bytes) *left -= bytes->size();
    return bytes;
  };
}

FileSource files_beside(const FileSource& files, const std::string& name) {
  if (!files) return {};
  const std::filesystem::path folder = std::filesystem::path(name).parent_path();
  return [files, folder](const std::string& other) {
    check_name(other);  // before it is joined, because an absolute path replaces the folder
    return files((folder / other).string());
  };
}

}  // namespace weft
