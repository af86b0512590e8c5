#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <weft/core/error.hpp>
#include <weft/core/input_file.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// A scene text that cannot be used. what() is "file:line:column: message", one line.
class SceneError : public InvalidArgument {
 public:
  SceneError(std::string file, int line, int column, const std::string& message);
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] int line() const { return line_; }      ///< from 1
  [[nodiscard]] int column() const { return column_; }  ///< from 1

 private:
  std::string file_;
  int line_;
  int column_;
};

/// The files that a scene has taken along.
[[nodiscard]] FileSource files_of(const Scene& scene);

/// Reads and checks a scene file, and the files that it names, which are in its folder or below.
/// Throws SceneError.
[[nodiscard]] Scene read_scene_file(const std::filesystem::path& path);
/// The same for a text; name stands for the file in messages. Without files no file may be named.
[[nodiscard]] Scene read_scene_text(std::string_view text, const std::string& name,
                                    const FileSource& files = {});

/// The resolved scene: TOML with every default written out, which reads back to the same scene, bit
/// for bit.
[[nodiscard]] std::string write_scene(const Scene& scene);

}  // namespace weft::scenes
