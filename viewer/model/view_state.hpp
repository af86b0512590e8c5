#pragma once

// Tested by tests/viewer/model/view_state_test.cpp.

#include <array>
#include <string>

#include <weft/playback/rendering/renderer.hpp>
#include <weft/viewer/model/action.hpp>

namespace weft::viewer {

struct WindowSize {
  int width = 0;  ///< [screen unit]
  int height = 0;
};

/// Sizes that the keys go through.
inline constexpr std::array<WindowSize, 5> kWindowSizes = {
    {{800, 500}, {1024, 640}, {1280, 800}, {1600, 1000}, {1920, 1200}}};

/// How the window looks: plain data that needs no window.
struct ViewState {
  scenes::SurfaceStyle style = scenes::SurfaceStyle::kShaded;
  scenes::Camera camera;
  bool has_shadow = true;
  bool shows_worst = false;
  bool shows_contacts = false;
  bool shows_panels = true;
  bool shows_laws = true;
  bool shows_plots = true;
  bool shows_help = false;
  bool shows_list = false;
  bool is_full_screen = false;
  double text_scale = 1.0;
  WindowSize size = kWindowSizes[2];
  bool wants_screenshot = false;
  std::string screenshot_path = {};  ///< empty: a name that is free, in the current folder
  bool is_filming = false;
  bool wants_to_quit = false;
};

/// Does what concerns the looks alone; false for any other action. home: the scene's own camera.
bool perform(ViewState& view, Action action, const scenes::Camera& home);

/// "shaded", "wireframe", "strain"
[[nodiscard]] std::string style_name(scenes::SurfaceStyle style);

}  // namespace weft::viewer
