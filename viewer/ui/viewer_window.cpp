#include <weft/viewer/ui/viewer_window.hpp>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/scenes/output/output_file.hpp>
#include <weft/viewer/ui/panels/panels.hpp>
#include <weft/viewer/ui/theme.hpp>
#include <weft/viewer/ui/thumbnails.hpp>
#include <weft/viewer/ui/window_film.hpp>

namespace weft::viewer {
namespace {

constexpr double kRoomForPanels = 1000.0;  // [pixel] of the window's width at scale 1

/// Dear ImGui for one window.
class PanelContext {
 public:
  explicit PanelContext(Window& window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  PanelContext(const PanelContext&) = delete;
  PanelContext& operator=(const PanelContext&) = delete;
  ~PanelContext() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }

  void begin(double scale) {
    if (scale != scale_) {
      scale_ = scale;
      apply_theme(scale);
      ImGui_ImplOpenGL3_DestroyFontsTexture();
      ImGui_ImplOpenGL3_CreateFontsTexture();
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
  }
  static void end() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }

 private:
  double scale_ = 0.0;
};

/// The mouse over the picture; over panels it is theirs.
void handle_mouse(Session& session) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!(io.DisplaySize.x > 0.0f && io.DisplaySize.y > 0.0f)) return;
  const double aspect = static_cast<double>(io.DisplaySize.x / io.DisplaySize.y);
  const Place place{static_cast<double>(io.MousePos.x / io.DisplaySize.x),
                    static_cast<double>(io.MousePos.y / io.DisplaySize.y)};
  static int button = -1;
  if (button >= 0) {
    if (ImGui::IsMouseDown(button)) {
      session.drag_to(place, aspect);
    } else {
      session.end_drag();
      button = -1;
    }
    return;
  }
  if (io.WantCaptureMouse) return;
  if (io.MouseWheel != 0.0f) session.scroll(static_cast<double>(io.MouseWheel));
  for (const int pressed :
       {ImGuiMouseButton_Left, ImGuiMouseButton_Right, ImGuiMouseButton_Middle}) {
    if (!ImGui::IsMouseClicked(pressed)) continue;
    button = pressed;
    const bool pulls = pressed == ImGuiMouseButton_Middle || (pressed == 0 && io.KeyCtrl);
    const bool carries = pressed == 0 && io.KeyShift && !pulls;
    session.begin_drag(pulls                               ? MouseDrag::kPull
                       : carries                           ? MouseDrag::kCarry
                       : pressed == ImGuiMouseButton_Right ? MouseDrag::kPan
                                                           : MouseDrag::kRotate,
                       place, aspect);
    return;
  }
}

void draw_panels(Session& session, const Stage& stage, Thumbnails& thumbnails, double scale) {
  const ImGuiIO& io = ImGui::GetIO();
  const PanelFrame frame{session,          stage,           thumbnails, static_cast<float>(scale),
                         io.DisplaySize.x, io.DisplaySize.y};
  const ViewState& view = session.view();
  draw_marks(frame);
  if (view.shows_panels) {
    draw_control_panel(frame);
    draw_timeline(frame);
    if (view.shows_laws) draw_law_panel(frame);
    if (view.shows_plots) draw_plot_panel(frame);
    draw_message(frame);
  }
  if (view.shows_list) draw_scene_list(frame);
  if (view.shows_help) draw_help(frame);
}

std::string free_screenshot_name() {
  for (int number = 1;; ++number) {
    std::string name = "weft-view-" + std::to_string(number) + ".png";
    if (!std::filesystem::exists(name)) return name;
  }
}

void save_screenshot(Session& session, Stage& stage) {
  ViewState& view = session.view();
  view.wants_screenshot = false;
  std::string path = std::exchange(view.screenshot_path, {});
  if (path.empty()) path = free_screenshot_name();
  try {
    scenes::write_png(path, stage.read_window());
    session.tell("saved " + path);
  } catch (const Error& error) {
    session.tell(error.what());
  }
}

/// Gives the window the size that the view state asks for, and tells the state what the user has done to it.
class WindowFollower {
 public:
  explicit WindowFollower(const ViewState& view) : size_(view.size), title_() {}

  void follow(Session& session, Window& window) {
    ViewState& view = session.view();
    if (view.size.width != size_.width || view.size.height != size_.height) {
      window.set_size(view.size);
    } else if (!view.is_full_screen) {
      view.size = window.size();
    }
    size_ = view.size;
    window.set_full_screen(view.is_full_screen);
    if (title_ != session.title()) {
      title_ = session.title();
      window.set_title("Weft: " + title_);
    }
  }

 private:
  WindowSize size_;
  std::string title_;
};

bool begins_as_state(std::string_view beginning) {
  // A blow-up comes before the camera, by name.
  return beginning.starts_with("{\n  \"camera\": {") ||
         (beginning.starts_with("{\n  \"blow_up\": \"") &&
          beginning.find("\n  \"camera\": {") != std::string_view::npos);
}

constexpr output::FileKind kStateKind{"the state of a window", begins_as_state};

/// Throws Error for a run that did not come to the end that was asked for.
void check_run(Session& session) {
  if (session.live() == nullptr) return;
  const Simulation& simulation = session.live()->simulation();
  if (const auto failure = simulation.failure()) throw Error(*failure);
  const std::string unfinished = simulation.unfinished_recording();
  if (unfinished.empty()) return;
  throw Error(
      "--record: the window was closed before the scene's duration was over; the frames so far are "
      "kept in " +
      unfinished);
}

bool has_ended(Session& session) {
  if (session.live() == nullptr) return false;
  const Simulation& simulation = session.live()->simulation();
  return simulation.reached_end() || simulation.failure();
}

void write_state(const ViewerSettings& settings, Session& session) {
  if (settings.state_file.empty()) return;
  output::write_file(settings.state_file, kStateKind, session.describe());
}

}  // namespace

void run_viewer(ViewerSettings settings) {
  Window window("Weft", settings.size);
  Session session(settings.session);
  session.view().size = settings.size;
  Stage stage(window);
  window.set_on_key([&](const std::string& key) {
    if (!ImGui::GetIO().WantTextInput) (void)session.press(key);
  });
  PanelContext panels(window);
  const double first_scale = settings.scale > 0.0 ? settings.scale : window.content_scale();
  // In a small window they would leave no room for the picture.
  session.view().shows_laws = session.view().shows_plots =
      settings.size.width >= kRoomForPanels * first_scale;
  Thumbnails thumbnails(window);
  WindowFilm film;
  WindowFollower follower(session.view());
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  while (!window.wants_to_close() && !session.view().wants_to_quit) {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last).count();
    last = now;
    const WindowSize size = window.framebuffer_size();
    const double aspect = size.height > 0 ? static_cast<double>(size.width) / size.height : 1.0;
    settings.script.advance(session, seconds, aspect);
    session.update(seconds);
    follower.follow(session, window);
    stage.draw(session);
    const double base = settings.scale > 0.0 ? settings.scale : window.content_scale();
    const double scale = base * session.view().text_scale;
    panels.begin(scale);
    handle_mouse(session);
    draw_panels(session, stage, thumbnails, scale);
    PanelContext::end();
    film.follow(session, stage, seconds);
    if (session.view().wants_screenshot) save_screenshot(session, stage);
    window.present();
    if (!std::filesystem::exists(settings.state_file)) write_state(settings, session);
    if (settings.exits_at_end && has_ended(session)) break;
  }
  film.finish(session);
  write_state(settings, session);
  check_run(session);
}

}  // namespace weft::viewer
