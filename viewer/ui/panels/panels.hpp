#pragma once

// Tested by tests/viewer/window_test.py.

#include <weft/viewer/session.hpp>
#include <weft/viewer/ui/stage.hpp>
#include <weft/viewer/ui/thumbnails.hpp>

namespace weft::viewer {

/// The panels, each in a file of its name. Lengths are in pixels times scale; all of them act through
/// Session::perform() and the other handlers that keys and scripts use.
struct PanelFrame {
  Session& session;
  const Stage& stage;
  Thumbnails& thumbnails;
  float scale = 1.0f;
  float width = 0.0f;  ///< of the window
  float height = 0.0f;
};

void draw_control_panel(const PanelFrame& frame);
void draw_law_panel(const PanelFrame& frame);
void draw_plot_panel(const PanelFrame& frame);
void draw_timeline(const PanelFrame& frame);
void draw_scene_list(const PanelFrame& frame);
void draw_help(const PanelFrame& frame);
void draw_message(const PanelFrame& frame);
/// Draws the marks over the picture itself: legend, worst node, pull.
void draw_marks(const PanelFrame& frame);

/// A button for an action, with its tooltip. width 0: as wide as the label.
bool action_button(Session& session, Action action, const char* label, float width = 0.0f);
/// The tooltip of an action for the control before.
void tip(Action action);
/// A panel at a place; is_right: x counts from the right edge, likewise is_low. height 0: as its content.
void begin_panel(const PanelFrame& frame, const char* name, float x, float y, float width,
                 float height, bool is_right, bool is_low);

inline constexpr float kMargin = 10.0f;
inline constexpr float kTimelineHeight = 74.0f;
inline constexpr float kControlWidth = 236.0f;
inline constexpr float kLawWidth = 300.0f;
inline constexpr float kPlotHeight = 250.0f;

}  // namespace weft::viewer
