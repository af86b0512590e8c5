#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include <weft/scenes/output/file_kind.hpp>
#include <weft/scenes/output/output_lock.hpp>

namespace weft::output {

/// A folder that one command fills and owns: new, empty, or filled by the same command before. What
/// it holds may be replaced. The hidden file kFolderMark in it says so, and is its lock.
class OutputFolder {
 public:
  /// Makes the folder if needed. token, a file in it of this kind, makes a folder of a version
  /// without the mark one of ours.
  /// @throws Error if the path is a symbolic link or no folder, if the folder holds other files, or
  /// if another run fills it.
  OutputFolder(std::filesystem::path path, std::string_view token, const FileKind& kind);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Makes a folder inside, and its parents. @throws Error also if one of them is a symbolic link.
  std::filesystem::path make_folder(const std::filesystem::path& relative) const;

  /// Writes a file inside, whole or not at all, over the one that is there if that is a plain file.
  /// @throws Error that names the path and the reason.
  void write(const std::filesystem::path& relative, std::string_view bytes) const;

 private:
  std::filesystem::path path_;
  std::optional<OutputLock> lock_;
};

inline constexpr std::string_view kFolderMark = ".weft-output";

/// Writes a file of a folder that belongs to this program, whole or not at all, over a plain file
/// and nothing else. @throws Error.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace weft::output
