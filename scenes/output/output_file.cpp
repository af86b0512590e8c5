#include <weft/scenes/output/output_file.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::output {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int reason) {
  throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(reason)));
}

const char* name_of_type(mode_t mode) {
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

fs::path folder_of(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// Gives a file a name that nobody has; false if somebody has it.
bool rename_new(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno == EEXIST) return false;
  if (errno != EINVAL && errno != ENOSYS) fail(to, errno);
  // A file system without that call: a second name, which never replaces either.
  if (link(from.c_str(), to.c_str()) != 0) {
    if (errno == EEXIST) return false;
    fail(to, errno);
  }
  unlink(from.c_str());
  return true;
}

/// What was renamed survives a loss of power. A file system that cannot promise it has to do.
void sync_folder(const fs::path& path) {
  const int folder = open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  (void)fsync(folder);
  close(folder);
}

void sync_file(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) fail(path, errno);
  const int reason = fsync(file) == 0 ? 0 : errno;
  close(file);
  if (reason != 0) fail(path, reason);
}

/// 0, or the reason why not all was written.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return fsync(file) == 0 ? 0 : errno;
}

}  // namespace

std::optional<OutputFile::Identity> OutputFile::identity(const fs::path& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return std::nullopt;
  return Identity{status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
                  status.st_mtim.tv_nsec};
}

OutputFile::OutputFile(fs::path path, const FileKind& kind, bool force) : path_(std::move(path)) {
  const std::string name = path_.string();
  if (!path_.has_filename()) {
    throw InvalidArgument(fmt::format("{}: is a folder, expected the name of a file", name));
  }
  struct stat status {};
  if (lstat(path_.c_str(), &status) != 0) {
    if (errno != ENOENT) fail(path_, errno);
    if (!fs::is_directory(folder_of(path_))) {
      throw InvalidArgument(
          fmt::format("{}: there is no folder {}", name, folder_of(path_).string()));
    }
    return;
  }
  if (!S_ISREG(status.st_mode)) {
    throw InvalidArgument(fmt::format("{}: is {}, expected a new name or {}", name,
                                      name_of_type(status.st_mode), kind.name));
  }
  replaced_ = identity(path_);
  if (!is_of_kind(path_, kind)) {
    throw InvalidArgument(
        fmt::format("{}: exists and is not {} made by Weft, expected a new name", name, kind.name));
  }
  if (kind.needs_force && !force) {
    throw InvalidArgument(name + ": exists already, expected a new name or --force");
  }
}

fs::path numbered(const fs::path& path, int number) {
  return path.parent_path() /
         fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string());
}

void OutputFile::keep_beside(const fs::path& finished) const {
  fs::path kept;
  int number = 2;
  do {
    kept = numbered(path_, number++);
  } while (!rename_new(finished, kept));
  sync_folder(kept);
  throw Error(
      fmt::format("{}: another file has got this name in the meantime and is left as it is; the "
                  "result is in {}",
                  path_.string(), kept.string()));
}

/// False if the place is no longer as it was.
bool OutputFile::replace(const fs::path& finished) const {
  if (identity(path_) != replaced_) return false;
  if (renameat2(AT_FDCWD, finished.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) == 0) {
    if (identity(finished) == replaced_) {
      unlink(finished.c_str());
      return true;
    }
    // Changed between the look and the exchange: back again.
    if (renameat2(AT_FDCWD, finished.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) != 0) {
      fail(path_, errno);
    }
    return false;
  }
  if (errno == ENOENT) return false;
  if (errno != EINVAL && errno != ENOSYS) fail(path_, errno);
  if (std::rename(finished.c_str(), path_.c_str()) != 0) fail(path_, errno);
  return true;
}

void OutputFile::publish(const fs::path& finished) const {
  sync_file(finished);
  const bool done = replaced_ && identity(path_) ? replace(finished) : rename_new(finished, path_);
  if (!done) keep_beside(finished);
  sync_folder(path_);
}

fs::path write_beside(const fs::path& path, std::string_view bytes) {
  int file = -1;
  fs::path temporary;
  for (int number = 1; file < 0; ++number) {
    // A name of its own kind and length: that of path may be as long as a name can be.
    temporary = path.parent_path() / fmt::format(".weft-{}-{}.tmp", getpid(), number);
    file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) fail(path, errno);
  }
  int reason = write_all(file, bytes);
  if (close(file) != 0 && reason == 0) reason = errno;
  if (reason == 0) return temporary;
  unlink(temporary.c_str());
  fail(path, reason);
}

void OutputFile::write(std::string_view bytes) const {
  const fs::path temporary = write_beside(path_, bytes);
  try {
    publish(temporary);
  } catch (...) {
    unlink(temporary.c_str());  // not there any more if the result has got another name
    throw;
  }
}

void write_file(const fs::path& path, const FileKind& kind, std::string_view bytes) {
  OutputFile(path, kind).write(bytes);
}

}  // namespace weft::output
