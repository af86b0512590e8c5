// This file keeps the promises of regular_file.hpp by the functions of POSIX.
// Tested by tests/core/input_file_test.cpp.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <weft/core/error.hpp>
#include <weft/core/regular_file.hpp>

namespace weft {
namespace {

[[noreturn]] void fail_read() {
  throw InvalidArgument("cannot be read: " + std::string(std::strerror(errno)));
}

int open_for_reading(const std::filesystem::path& path, RegularFile::Links links) {
  // Without O_NONBLOCK, opening a pipe waits for its writer; O_NOCTTY keeps a terminal from
  // becoming the process's own.
  const int more_flags = links == RegularFile::Links::kRefuse ? O_NOFOLLOW : 0;
  const int number = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY | more_flags);
  if (number >= 0) return number;
  if (errno == ENOENT || errno == ENOTDIR) throw InvalidArgument("no such file");
  throw InvalidArgument("cannot be opened: " + std::string(std::strerror(errno)));
}

/// [bytes]
std::uintmax_t regular_size(int number) {
  struct stat status {};
  if (fstat(number, &status) != 0) fail_read();
  if (S_ISDIR(status.st_mode)) throw InvalidArgument("is a directory, expected a file");
  if (!S_ISREG(status.st_mode)) {
    throw InvalidArgument("is a pipe, a socket or a device, expected a regular file");
  }
  return static_cast<std::uintmax_t>(status.st_size);
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& path, Links links)
    : handle_(open_for_reading(path, links)) {
  try {
    size_ = regular_size(static_cast<int>(handle_));
  } catch (...) {
    close(static_cast<int>(handle_));
    throw;
  }
}

RegularFile::~RegularFile() {
  close(static_cast<int>(handle_));
}

bool RegularFile::read_more(std::size_t size, std::string& bytes) const {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + size);
  ssize_t count = -1;
  do {
    count = read(static_cast<int>(handle_), bytes.data() + begin, size);
  } while (count < 0 && errno == EINTR);
  if (count < 0) fail_read();
  bytes.resize(begin + static_cast<std::size_t>(count));
  return count > 0;
}

std::filesystem::path real_path(const std::filesystem::path& path, std::error_code& error) {
  return std::filesystem::canonical(path, error);
}

}  // namespace weft
