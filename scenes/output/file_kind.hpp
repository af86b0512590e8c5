#pragma once

// Tested by tests/scenes/output/output_file_test.cpp, tests/scenes/output/output_folder_test.cpp.

#include <filesystem>
#include <string_view>

namespace weft::output {

/// A kind of file that Weft makes, recognized by what is in it and never by its name.
struct FileKind {
  std::string_view name;  ///< with its article, as messages say it: "a recording"
  /// Whether a file that begins so is of this kind and Weft's; it sees at most kBeginningBytes.
  bool (*recognizes)(std::string_view beginning);
  /// Whether it takes --force to replace one. Not for what can be made anew in a moment.
  bool needs_force = false;
};

inline constexpr std::size_t kBeginningBytes = 4096;

/// Whether there is a plain file of this kind; a symbolic link, a device or a pipe is none, and is
/// not opened.
[[nodiscard]] bool is_of_kind(const std::filesystem::path& path, const FileKind& kind);

}  // namespace weft::output
