#include <weft/viewer/model/view_state.hpp>

#include <algorithm>
#include <cstddef>

#include <weft/viewer/model/orbit.hpp>

namespace weft::viewer {
namespace {

using scenes::SurfaceStyle;

constexpr double kTurn = 0.1;   // [rad] of a key
constexpr double kMove = 0.05;  // [height of the picture]
constexpr double kZoom = 1.1;   // [-]
constexpr double kTextStep = 1.25;

bool perform_camera(ViewState& view, Action action, const scenes::Camera& home) {
  scenes::Camera& camera = view.camera;
  switch (action) {
    case Action::kRotateLeft:
      rotate(camera, -kTurn, 0.0);
      return true;
    case Action::kRotateRight:
      rotate(camera, kTurn, 0.0);
      return true;
    case Action::kRotateUp:
      rotate(camera, 0.0, kTurn);
      return true;
    case Action::kRotateDown:
      rotate(camera, 0.0, -kTurn);
      return true;
    case Action::kMoveLeft:
      pan(camera, -kMove, 0.0);
      return true;
    case Action::kMoveRight:
      pan(camera, kMove, 0.0);
      return true;
    case Action::kMoveUp:
      pan(camera, 0.0, kMove);
      return true;
    case Action::kMoveDown:
      pan(camera, 0.0, -kMove);
      return true;
    case Action::kZoomIn:
      zoom(camera, kZoom);
      return true;
    case Action::kZoomOut:
      zoom(camera, 1.0 / kZoom);
      return true;
    case Action::kResetView:
      camera = home;
      return true;
    default:
      return false;
  }
}

void change_size(ViewState& view, int direction) {
  // A size that the user has drawn is followed by the next one in that direction.
  const auto is_smaller = [&](const WindowSize& size) { return size.width < view.size.width; };
  auto row = std::count_if(kWindowSizes.begin(), kWindowSizes.end(), is_smaller);
  const bool is_exact = row < std::ssize(kWindowSizes) &&
                        kWindowSizes[static_cast<std::size_t>(row)].width == view.size.width;
  if (direction < 0 || is_exact) row += direction;
  view.size = kWindowSizes[static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(row, 0, std::ssize(kWindowSizes) - 1))];
}

bool* shown_flag(ViewState& view, Action action) {
  switch (action) {
    case Action::kShadow:
      return &view.has_shadow;
    case Action::kWorstNode:
      return &view.shows_worst;
    case Action::kContacts:
      return &view.shows_contacts;
    case Action::kFilm:
      return &view.is_filming;
    case Action::kPanels:
      return &view.shows_panels;
    case Action::kLaws:
      return &view.shows_laws;
    case Action::kPlots:
      return &view.shows_plots;
    case Action::kHelp:
      return &view.shows_help;
    case Action::kSceneList:
      return &view.shows_list;
    case Action::kFullScreen:
      return &view.is_full_screen;
    default:
      return nullptr;
  }
}

}  // namespace

bool perform(ViewState& view, Action action, const scenes::Camera& home) {
  if (perform_camera(view, action, home)) return true;
  if (bool* flag = shown_flag(view, action)) {
    *flag = !*flag;
    return true;
  }
  switch (action) {
    case Action::kNextStyle:
      view.style = static_cast<SurfaceStyle>((static_cast<int>(view.style) + 1) % 3);
      return true;
    case Action::kShaded:
      view.style = SurfaceStyle::kShaded;
      return true;
    case Action::kWireframe:
      view.style = SurfaceStyle::kWireframe;
      return true;
    case Action::kStrain:
      view.style = SurfaceStyle::kScalar;
      return true;
    case Action::kWindowLarger:
    case Action::kWindowSmaller:
      change_size(view, action == Action::kWindowLarger ? 1 : -1);
      return true;
    case Action::kLargerText:
    case Action::kSmallerText:
      view.text_scale = std::clamp(
          view.text_scale * (action == Action::kLargerText ? kTextStep : 1.0 / kTextStep), 0.5,
          4.0);
      return true;
    case Action::kScreenshot:
      view.wants_screenshot = true;
      return true;
    case Action::kClose:
      view.shows_help = view.shows_list = false;
      return true;
    case Action::kQuit:
      view.wants_to_quit = true;
      return true;
    default:
      return false;
  }
}

std::string style_name(SurfaceStyle style) {
  switch (style) {
    case SurfaceStyle::kShaded:
      return "shaded";
    case SurfaceStyle::kWireframe:
      return "wireframe";
    case SurfaceStyle::kScalar:
      break;
  }
  return "strain";
}

}  // namespace weft::viewer
