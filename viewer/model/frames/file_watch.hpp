#pragma once

// Tested by tests/viewer/model/frames/file_watch_test.cpp.

#include <cstdint>
#include <filesystem>
#include <optional>

namespace weft::viewer {

/// Notices that a file was saved, by its time and size.
class FileWatch {
 public:
  FileWatch() = default;
  /// Watches this file from now on; none if it is not there.
  explicit FileWatch(std::filesystem::path path);

  /// Whether it was saved since the last call. It must have kept still between two calls, so that a file
  /// is not read while an editor writes it.
  [[nodiscard]] bool was_saved();

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    bool operator==(const Stamp&) const = default;
  };
  [[nodiscard]] std::optional<Stamp> stamp() const;

  std::filesystem::path path_;
  std::optional<Stamp> known_;
  std::optional<Stamp> last_;
};

}  // namespace weft::viewer
