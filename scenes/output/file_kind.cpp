#include <weft/scenes/output/file_kind.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace weft::output {

bool is_of_kind(const std::filesystem::path& path, const FileKind& kind) {
  struct stat before {};
  if (lstat(path.c_str(), &before) != 0 || !S_ISREG(before.st_mode)) return false;
  // Without waiting: it may have become a pipe since.
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  std::array<char, kBeginningBytes> bytes{};
  std::size_t count = 0;
  while (count < bytes.size()) {
    const ssize_t more = read(file, bytes.data() + count, bytes.size() - count);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) break;
    count += static_cast<std::size_t>(more);
  }
  close(file);
  return kind.recognizes(std::string_view(bytes.data(), count));
}

}  // namespace weft::output
