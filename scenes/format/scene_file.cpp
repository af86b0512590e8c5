#include <weft/scenes/format/scene_file.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <weft/scenes/format/reading/scene_reader.hpp>
#include <weft/scenes/format/spelling.hpp>
#include <weft/scenes/format/text_guard.hpp>

namespace weft::scenes {
namespace {

// Long enough for any real path and parser message, short enough for one line.
constexpr std::size_t kMaxMessageLength = 1000;

}  // namespace

SceneError::SceneError(std::string file, int line, int column, const std::string& message)
    : InvalidArgument(fmt::format("{}:{}:{}: {}", shown(file, kMaxMessageLength), line, column,
                                  shown(message, kMaxMessageLength))),
      file_(std::move(file)),
      line_(line),
      column_(column) {}

Scene read_scene_file(const std::filesystem::path& path) {
  std::string text;
  try {
    text = read_input_file(path, kMaxTextSize);
  } catch (const InvalidArgument& error) {
    std::string reason = error.what();
    if (reason == "no such file") reason += ", expected a scene file or a catalog name";
    throw SceneError(path.string(), 1, 1, reason);
  }
  return read_scene_text(text, path.string(), files_below(path.parent_path()));
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
  const TomlSource source{name, files};
  return read_scene(TomlTable(source, "", root));
}

}  // namespace weft::scenes
