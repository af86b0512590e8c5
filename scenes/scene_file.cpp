#include <weft/scenes/scene_file.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <weft/scenes/scene_reader.hpp>
#include <weft/scenes/spelling.hpp>
#include <weft/scenes/text_guard.hpp>

namespace weft::scenes {
namespace {

// Long enough for any real path and parser message, short enough for one line.
constexpr std::size_t kMaxMessageLength = 1000;

std::string read_bytes(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) {
    throw SceneError(path.string(), 1, 1, "no such file, expected a scene file or a catalog name");
  }
  if (std::filesystem::is_directory(status)) {
    throw SceneError(path.string(), 1, 1, "is a directory, expected a scene file");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw SceneError(path.string(), 1, 1, "cannot be opened, expected a readable file");
  // One byte over the limit is enough for the reader to refuse it, also for endless devices.
  std::string text(kMaxTextSize + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad())
    throw SceneError(path.string(), 1, 1, "cannot be read, expected a readable file");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

std::optional<std::string> read_beside(const std::filesystem::path& scene,
                                       const std::string& name) {
  const std::filesystem::path path = scene.parent_path() / name;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  std::ifstream stream(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) return std::nullopt;
  return bytes;
}

}  // namespace

SceneError::SceneError(std::string file, int line, int column, const std::string& message)
    : InvalidArgument(fmt::format("{}:{}:{}: {}", shown(file, kMaxMessageLength), line, column,
                                  shown(message, kMaxMessageLength))),
      file_(std::move(file)),
      line_(line),
      column_(column) {}

Scene read_scene_file(const std::filesystem::path& path) {
  return read_scene_text(read_bytes(path), path.string(),
                         [&](const std::string& name) { return read_beside(path, name); });
}

FileSource files_of(const Scene& scene) {
  return [files = scene.files](const std::string& name) -> std::optional<std::string> {
    for (const SceneFile& file : files) {
      if (file.name == name) return file.bytes;
    }
    return std::nullopt;
  };
}

Scene read_scene_text(std::string_view text, const std::string& name, const FileSource& files) {
  if (const std::optional<TextDefect> defect = find_text_defect(text)) {
    throw SceneError(name, defect->line, defect->column, defect->message);
  }
  toml::table root;
  try {
    root = toml::parse(text, std::string_view(name));
  } catch (const toml::parse_error& error) {
    const toml::source_position& place = error.source().begin;
    throw SceneError(name, std::max(1, static_cast<int>(place.line)),
                     std::max(1, static_cast<int>(place.column)), std::string(error.description()));
  }
  return read_scene(TomlTable(name, "", root), files);
}

}  // namespace weft::scenes
