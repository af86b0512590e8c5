#pragma once

// Tested by tests/viewer/window_test.py.

#include <memory>
#include <optional>

#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/opengl/gl_functions.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/viewer/model/strain_scale.hpp>
#include <weft/viewer/session.hpp>
#include <weft/viewer/ui/window.hpp>

namespace weft::viewer {

/// Draws the picture behind the panels with the renderer of `weft render`. It is drawn anew only when
/// something has changed, and kept in a framebuffer in between, so that panels answer at once.
class Stage {
 public:
  explicit Stage(Window& window);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Draws into the window's framebuffer.
  void draw(Session& session);
  /// The present content of the framebuffer, panels included.
  [[nodiscard]] scenes::Image read_window();

  [[nodiscard]] const StrainScale& strain_scale() const { return strain_scale_; }

 private:
  /// Everything that a picture depends on.
  struct Key {
    SnapshotPtr shown;
    int version = 0;
    const Source* source = nullptr;
    WindowSize size;
    scenes::SurfaceStyle style = scenes::SurfaceStyle::kShaded;
    bool has_shadow = true;
    Vector3<double> position{0, 0, 0};
    Vector3<double> target{0, 0, 0};
    int samples = 0;
  };
  [[nodiscard]] static bool is_same(const Key& a, const Key& b);
  void resize(const WindowSize& size);
  void open_scene(Session& session);
  void paint(Session& session, const Key& key);
  [[nodiscard]] int samples_for(const Key& key);

  Window& window_;
  std::unique_ptr<scenes::GlContext> context_;
  scenes::GlFunctions gl_;
  std::unique_ptr<scenes::Renderer> renderer_;
  std::unique_ptr<Meter> meter_;
  StrainScale strain_scale_;
  GLuint framebuffer_ = 0;
  GLuint texture_ = 0;
  WindowSize size_;
  Key drawn_;
  double fine_time_ = 0.0;    ///< [s] wall time of the last picture with all samples
  double still_since_ = 0.0;  ///< [s] of the program's clock
};

}  // namespace weft::viewer
