#include <weft/viewer/model/action.hpp>

#include <array>
#include <stdexcept>

namespace weft::viewer {
namespace {

using enum Action;

// The one list of actions. Keys of a text are those of an American keyboard.
// clang-format off
constexpr std::array kTable = std::to_array<ActionInfo>({
    {kPause, "pause", "Time", "Space", "Run or pause"},
    {kStepForward, "step_forward", "Time", "Right", "One frame forward; live, at the end: simulate one step"},
    {kStepBack, "step_back", "Time", "Left", "One frame back; live: look back, nothing is simulated again"},
    {kTakeBack, "take_back", "Time", "B", "Live and paused: take back a step that was simulated by hand, and go on from there"},
    {kFirstFrame, "first_frame", "Time", "Home", "First frame that is kept"},
    {kLastFrame, "last_frame", "Time", "End", "Last frame"},
    {kFaster, "faster", "Time", "]", "Play faster"},
    {kSlower, "slower", "Time", "[", "Play slower"},
    {kLoop, "loop", "Time", "L", "Start a recording again at its end, or stop there"},
    {kRestart, "restart", "Time", "R", "Start again, with the laws as they are set now"},
    {kRestartAsWritten, "restart_as_written", "Time", "Shift+R", "Start again, with the laws as the scene has them"},

    {kWindXMore, "wind_x_more", "Wind", "X", "Wind along x: 0.5 m/s more"},
    {kWindXLess, "wind_x_less", "Wind", "Shift+X", "Wind along x: 0.5 m/s less"},
    {kWindYMore, "wind_y_more", "Wind", "Y", "Wind along y (up): 0.5 m/s more"},
    {kWindYLess, "wind_y_less", "Wind", "Shift+Y", "Wind along y (up): 0.5 m/s less"},
    {kWindZMore, "wind_z_more", "Wind", "Z", "Wind along z: 0.5 m/s more"},
    {kWindZLess, "wind_z_less", "Wind", "Shift+Z", "Wind along z: 0.5 m/s less"},

    {kGravityXMore, "gravity_x_more", "Gravity", "Ctrl+X", "Gravity along x: 1 m/s^2 more"},
    {kGravityXLess, "gravity_x_less", "Gravity", "Ctrl+Shift+X", "Gravity along x: 1 m/s^2 less"},
    {kGravityYMore, "gravity_y_more", "Gravity", "Ctrl+Y", "Gravity along y (up): 1 m/s^2 more"},
    {kGravityYLess, "gravity_y_less", "Gravity", "Ctrl+Shift+Y", "Gravity along y (up): 1 m/s^2 less"},
    {kGravityZMore, "gravity_z_more", "Gravity", "Ctrl+Z", "Gravity along z: 1 m/s^2 more"},
    {kGravityZLess, "gravity_z_less", "Gravity", "Ctrl+Shift+Z", "Gravity along z: 1 m/s^2 less"},

    {kNextCloth, "next_cloth", "Cloth and laws", "C", "Next cloth: as written, handkerchief, cotton, denim, paper"},
    {kPreviousCloth, "previous_cloth", "Cloth and laws", "Shift+C", "Type of cloth before"},
    {kLaws, "laws", "Cloth and laws", "K", "Show or hide the parameters of the laws"},
    {kNextParameter, "next_parameter", "Cloth and laws", "PageDown", "Choose the next parameter of a law"},
    {kPreviousParameter, "previous_parameter", "Cloth and laws", "PageUp", "Choose the parameter before"},
    {kLargerParameter, "larger_parameter", "Cloth and laws", "Ctrl+PageUp", "Make the chosen parameter larger by a tenth"},
    {kSmallerParameter, "smaller_parameter", "Cloth and laws", "Ctrl+PageDown", "Make the chosen parameter smaller by a tenth"},

    {kNextStyle, "next_style", "Picture", "S", "Next style: shaded, wireframe, strain"},
    {kShaded, "shaded", "Picture", "1", "Shaded"},
    {kWireframe, "wireframe", "Picture", "2", "Wireframe"},
    {kStrain, "strain", "Picture", "3", "Colors of the strain, with a legend"},
    {kShadow, "shadow", "Picture", "4", "Shadows on or off"},
    {kWorstNode, "worst_node", "Picture", "N", "Show the worst node: that of the largest strain"},
    {kContacts, "contacts", "Picture", "A", "Live: forces of colliders on the cloth as arrows, colored by friction"},
    {kGhosts, "ghosts", "Picture", "G", "Draw the other recordings as ghosts, or not at all"},
    {kNextGhost, "next_ghost", "Picture", "Shift+G", "Draw the next recording solid"},
    {kPlots, "plots", "Picture", "T", "Show or hide the plots"},

    {kRotateLeft, "rotate_left", "View", "Shift+Left", "Turn to the left; or drag with the left button"},
    {kRotateRight, "rotate_right", "View", "Shift+Right", "Turn to the right"},
    {kRotateUp, "rotate_up", "View", "Shift+Up", "Turn upwards"},
    {kRotateDown, "rotate_down", "View", "Shift+Down", "Turn downwards"},
    {kMoveLeft, "move_left", "View", "Ctrl+Left", "Move to the left; or drag with the right button"},
    {kMoveRight, "move_right", "View", "Ctrl+Right", "Move to the right"},
    {kMoveUp, "move_up", "View", "Ctrl+Up", "Move upwards"},
    {kMoveDown, "move_down", "View", "Ctrl+Down", "Move downwards"},
    {kZoomIn, "zoom_in", "View", "=", "Nearer; or the wheel (the key of +)"},
    {kZoomOut, "zoom_out", "View", "-", "Farther"},
    {kResetView, "reset_view", "View", "V", "The scene's own view"},

    {kSceneList, "scene_list", "Scene", "O", "Show or hide the list of scenes and files"},
    {kListUp, "list_up", "Scene", "Up", "Row above in the list"},
    {kListDown, "list_down", "Scene", "Down", "Row below in the list"},
    {kListOpen, "list_open", "Scene", "Enter", "Open the row of the list"},
    {kNextEngine, "next_engine", "Scene", "E", "Next engine, from the start of the scene"},
    {kReload, "reload", "Scene", "F5", "Read the file again; a saved scene is read by itself"},

    {kWindowLarger, "window_larger", "Window", "F7", "Next larger size of the window"},
    {kWindowSmaller, "window_smaller", "Window", "F6", "Next smaller size of the window"},
    {kFullScreen, "full_screen", "Window", "F11", "Whole screen, and back"},
    {kLargerText, "larger_text", "Window", "Ctrl+=", "Larger text and panels"},
    {kSmallerText, "smaller_text", "Window", "Ctrl+-", "Smaller text and panels"},
    {kPanels, "panels", "Window", "Tab", "Show or hide all panels"},
    {kScreenshot, "screenshot", "Window", "P", "Save the window as a PNG file; without panels after Tab"},
    {kFilm, "film", "Window", "M", "Begin a film of the window, an MP4 file in real time; or end it"},
    {kHelp, "help", "Window", "F1", "This list"},
    {kClose, "close", "Window", "Escape", "Close this list, or that of the scenes"},
    {kQuit, "quit", "Window", "Ctrl+Q", "Close the window"},
});
// clang-format on

}  // namespace

std::span<const ActionInfo> action_table() {
  return kTable;
}

const ActionInfo& info_of(Action action) {
  for (const ActionInfo& info : kTable) {
    if (info.action == action) return info;
  }
  throw std::logic_error("viewer: an action has no row in the input map");
}

const ActionInfo* find_key(std::string_view key) {
  for (const ActionInfo& info : kTable) {
    if (info.key == key) return &info;
  }
  return nullptr;
}

const ActionInfo* find_action(std::string_view id) {
  for (const ActionInfo& info : kTable) {
    if (info.id == id) return &info;
  }
  return nullptr;
}

std::string tooltip(Action action) {
  const ActionInfo& info = info_of(action);
  return std::string(info.help) + "  [" + std::string(info.key) + "]";
}

}  // namespace weft::viewer
