#pragma once

#include <sys/types.h>

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string_view>

#include <weft/scenes/output/file_kind.hpp>

namespace weft::output {

/// One file that a command writes: the one rule for every output.
///
/// Nothing there: it is written. A file of the same kind, made by Weft: it is replaced, a kind that
/// needs it only with force. Anything else, be it another file, a folder, a symbolic link, a device
/// or a pipe, is refused and stays as it is. The file appears whole or not at all, and one that
/// appears under its name in the meantime is not replaced.
class OutputFile {
 public:
  /// Looks at the place, before any work is done for it, and remembers what is there.
  /// @throws InvalidArgument that names the path, what is there and what was expected.
  OutputFile(std::filesystem::path path, const FileKind& kind, bool force = false);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Whether publish() replaces a file.
  [[nodiscard]] bool replaces() const { return replaced_.has_value(); }

  /// Writes the whole file. @throws Error with the path and the reason; nothing stays behind.
  void write(std::string_view bytes) const;

  /// Gives a finished file of the same folder this output's name, in one step.
  /// @throws Error if it cannot; also if the place is no longer as it was: what is there now stays,
  /// and finished has the name that the message tells.
  void publish(const std::filesystem::path& finished) const;

 private:
  /// What tells a file from any other, and from itself after a change.
  struct Identity {
    dev_t device;
    ino_t inode;
    off_t size;
    std::int64_t seconds;
    std::int64_t nanoseconds;
    bool operator==(const Identity&) const = default;
  };
  [[nodiscard]] static std::optional<Identity> identity(const std::filesystem::path& path);
  [[nodiscard]] bool replace(const std::filesystem::path& finished) const;
  [[noreturn]] void keep_beside(const std::filesystem::path& finished) const;

  std::filesystem::path path_;
  std::optional<Identity> replaced_;
};

/// OutputFile for bytes that are ready.
void write_file(const std::filesystem::path& path, const FileKind& kind, std::string_view bytes);

/// A new file with these bytes, safe on the disk, beside path and under a name that nobody has.
/// @throws Error with path and the reason; nothing stays behind.
[[nodiscard]] std::filesystem::path write_beside(const std::filesystem::path& path,
                                                 std::string_view bytes);

/// "a/b.png", 2 -> "a/b-2.png".
[[nodiscard]] std::filesystem::path numbered(const std::filesystem::path& path, int number);

}  // namespace weft::output
