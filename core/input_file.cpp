#include <weft/core/input_file.hpp>

#include <algorithm>
#include <memory>
#include <system_error>

#include <weft/core/error.hpp>
#include <weft/core/regular_file.hpp>

namespace weft {
namespace {

/// What is read in one piece: a file that shrinks or grows meanwhile costs one piece at most.
constexpr std::size_t kPieceSize = std::size_t{1} << 20U;

[[noreturn]] void fail_size(std::uintmax_t size, std::uintmax_t max_size) {
  throw InvalidArgument("has " + std::to_string(size) + " bytes, expected at most " +
                        std::to_string(max_size));
}

std::string read_all(const RegularFile& file, std::uintmax_t max_size) {
  if (file.size() > max_size) fail_size(file.size(), max_size);
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(file.size()));
  // The file may grow meanwhile: one byte more than may be is enough to see it.
  while (bytes.size() <= max_size &&
         file.read_more(std::min<std::uintmax_t>(kPieceSize, max_size + 1 - bytes.size()), bytes)) {
  }
  if (bytes.size() > max_size) fail_size(bytes.size(), max_size);
  return bytes;
}

void check_name(const std::filesystem::path& name) {
  // On Windows "C:name" and "\\name" replace a part of the folder too, though they are not absolute.
  if (name.has_root_path()) {
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
  const std::filesystem::path base = folder.empty() ? std::filesystem::path(".") : folder;
  const std::filesystem::path root = real_path(base, error);
  if (error) return std::nullopt;
  const std::filesystem::path path = real_path(base / name, error);
  if (error) return std::nullopt;
  if (!is_below(root, path)) {
    throw InvalidArgument("is a link out of the folder, expected a file in it or below it");
  }
  return read_all(RegularFile(path, RegularFile::Links::kRefuse), max_size);
}

}  // namespace

std::string read_input_file(const std::filesystem::path& path, std::uintmax_t max_size) {
  return read_all(RegularFile(path), max_size);
}

std::string read_input_start(const std::filesystem::path& path, std::size_t size) {
  const RegularFile file(path);
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
