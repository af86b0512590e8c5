#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace weft {

/// Largest input of which every byte is held in memory [bytes].
inline constexpr std::uintmax_t kMaxInputSize = 256'000'000;

/// The whole content of a regular file that a user has named. Never waits: a pipe, a socket or a
/// device is refused before a byte of it is read, and so is a file of more than max_size [bytes].
/// Throws InvalidArgument that says what is wrong, without the file's name.
[[nodiscard]] std::string read_input_file(const std::filesystem::path& path,
                                          std::uintmax_t max_size = kMaxInputSize);

/// The first bytes of such a file of any size, fewer if it is shorter. Throws likewise.
[[nodiscard]] std::string read_input_start(const std::filesystem::path& path, std::size_t size);

/// Gives the whole content of a file that another input names; none if there is no such file.
/// Throws InvalidArgument, without the file's name, for a file that may not be read.
using FileSource = std::function<std::optional<std::string>(const std::string& name)>;

/// The files in a folder and below it, which is all that an input in this folder may name: no
/// absolute path, no "..", and no symbolic link that leads out. Files that are read have
/// kMaxInputSize bytes in all.
[[nodiscard]] FileSource files_below(const std::filesystem::path& folder);

/// The same files by names that are relative to the place of another of them, as a mesh in a
/// subfolder names its buffers. Gives no source for no source.
[[nodiscard]] FileSource files_beside(const FileSource& files, const std::string& name);

}  // namespace weft
