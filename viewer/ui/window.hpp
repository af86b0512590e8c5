#pragma once

// Tested by tests/viewer/window_test.py.

#include <functional>
#include <memory>
#include <string>

#include <weft/playback/rendering/opengl/gl_context.hpp>
#include <weft/viewer/model/view_state.hpp>

struct GLFWwindow;

namespace weft::viewer {

/// A window of the desktop with an OpenGL 3.3 core context (GLFW).
class Window {
 public:
  /// Throws Error if there is no display, or none that offers OpenGL 3.3.
  Window(const std::string& title, const WindowSize& size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Called with the name of each key that is pressed or repeats, "Ctrl+Shift+X".
  void set_on_key(std::function<void(const std::string&)> on_key);

  [[nodiscard]] GLFWwindow* handle() { return window_; }
  /// The window's context for a renderer, which must not outlive the window.
  [[nodiscard]] std::unique_ptr<scenes::GlContext> context();

  [[nodiscard]] bool wants_to_close() const;
  [[nodiscard]] WindowSize size() const;              ///< [screen unit]
  [[nodiscard]] WindowSize framebuffer_size() const;  ///< [pixel]
  /// How much larger text must be on this screen, where the system does not enlarge windows by itself [-].
  [[nodiscard]] double content_scale() const;
  void set_size(const WindowSize& size);
  void set_full_screen(bool is_full);
  void set_title(const std::string& title);
  /// Shows what was drawn and handles input.
  void present();

 private:
  GLFWwindow* window_ = nullptr;
  std::function<void(const std::string&)> on_key_;
  double presented_ = 0.0;  ///< [s] of GLFW's clock
  bool is_full_ = false;
  int left_ = 0;  ///< place of the window before it was full screen
  int top_ = 0;
  WindowSize before_;
};

/// The name of a key of GLFW with modifiers, as in the input map: letters as the keyboard's layout has
/// them; empty for a modifier alone.
[[nodiscard]] std::string key_name(int key, int scancode, int modifiers);

}  // namespace weft::viewer
