#pragma once

// Tested by tests/core/input_file_test.cpp.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

namespace weft {

/// A regular file that is open for reading. Opening and reading it never waits. What depends on the system is in
/// regular_file_posix.cpp and regular_file_windows.cpp.
class RegularFile {
 public:
  enum class Links {
    kFollow,
    kRefuse,  ///< for a path of real_path(): a link that is there now was put there meanwhile
  };

  /// Throws InvalidArgument, without the file's name, for what is no regular file or cannot be opened.
  explicit RegularFile(const std::filesystem::path& path, Links links = Links::kFollow);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  /// When it was opened [bytes].
  [[nodiscard]] std::uintmax_t size() const { return size_; }
  /// Appends the next bytes, at most so many; says whether there were any. Throws InvalidArgument likewise.
  bool read_more(std::size_t size, std::string& bytes) const;

 private:
  std::intptr_t handle_;
  std::uintmax_t size_ = 0;
};

/// The path of an existing file or folder, absolute and without links; an error if there is none.
[[nodiscard]] std::filesystem::path real_path(const std::filesystem::path& path,
                                              std::error_code& error);

}  // namespace weft
