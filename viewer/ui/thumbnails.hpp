#pragma once

// Tested by tests/viewer/window_test.py.

#include <map>
#include <string>

#include <weft/playback/rendering/opengl/gl_functions.hpp>
#include <weft/viewer/ui/window.hpp>

namespace weft::viewer {

/// Small pictures of the entries of the list: how a scene starts, how a recording ends. They are drawn when they are asked for, one in
/// each picture of the window, so that the list opens at once.
class Thumbnails {
 public:
  static constexpr int kWidth = 144;  ///< [pixel]
  static constexpr int kHeight = 90;

  explicit Thumbnails(Window& window);
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  struct Entry {
    GLuint texture = 0;   ///< 0: not yet drawn, or it cannot be
    std::string summary;  ///< of the scene; or why there is no picture
  };
  /// To be called before the first get() of a picture of the window.
  void begin_picture() { has_drawn_ = false; }
  /// An entry without texture if it is not this one's turn.
  [[nodiscard]] const Entry& get(const std::string& name);

 private:
  [[nodiscard]] Entry draw(const std::string& name);

  Window& window_;
  scenes::GlFunctions gl_;
  std::map<std::string, Entry> entries_;
  bool has_drawn_ = false;
};

}  // namespace weft::viewer
