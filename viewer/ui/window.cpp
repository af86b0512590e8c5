#include <weft/viewer/ui/window.hpp>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <utility>

#include <weft/core/error.hpp>

namespace weft::viewer {
namespace {

constexpr double kShortestPicture = 1.0 / 75.0;  // [s]

class WindowContext final : public scenes::GlContext {
 public:
  explicit WindowContext(GLFWwindow* window) : window_(window) {}
  void make_current() override { glfwMakeContextCurrent(window_); }
  [[nodiscard]] Function find_function(const char* name) const override {
    return glfwGetProcAddress(name);
  }
  [[nodiscard]] std::string description() const override { return "the window's OpenGL context"; }

 private:
  GLFWwindow* window_;
};

[[noreturn]] void fail(const std::string& what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  const std::string text =
      what + (reason != nullptr ? " (" + std::string(reason) + ")" : std::string());
  glfwTerminate();
  throw Error(text);
}

}  // namespace

Window::Window(const std::string& title, const WindowSize& size) {
  if (glfwInit() != GLFW_TRUE) {
    fail("there is no display for a window, expected one; weft render draws without");
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) fail("the display has no OpenGL 3.3 core, expected it for a window");
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int scancode, int action, int mods) {
    auto* const self = static_cast<Window*>(glfwGetWindowUserPointer(window));
    if (action == GLFW_RELEASE || !self->on_key_) return;
    const std::string name = key_name(key, scancode, mods);
    if (!name.empty()) self->on_key_(name);
  });
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::set_on_key(std::function<void(const std::string&)> on_key) {
  on_key_ = std::move(on_key);
}

std::unique_ptr<scenes::GlContext> Window::context() {
  return std::make_unique<WindowContext>(window_);
}

bool Window::wants_to_close() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

WindowSize Window::size() const {
  WindowSize size;
  glfwGetWindowSize(window_, &size.width, &size.height);
  return size;
}

WindowSize Window::framebuffer_size() const {
  WindowSize size;
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

double Window::content_scale() const {
  float x = 1.0f;
  float y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  const WindowSize screen = size();
  const double already =
      screen.width > 0 ? static_cast<double>(framebuffer_size().width) / screen.width : 1.0;
  return already > 1.0 ? 1.0 : static_cast<double>(x);
}

void Window::set_size(const WindowSize& size) {
  if (!is_full_) glfwSetWindowSize(window_, size.width, size.height);
}

void Window::set_full_screen(bool is_full) {
  if (is_full == is_full_) return;
  is_full_ = is_full;
  if (!is_full) {
    glfwSetWindowMonitor(window_, nullptr, left_, top_, before_.width, before_.height, 0);
    return;
  }
  glfwGetWindowPos(window_, &left_, &top_);
  before_ = size();
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  if (mode == nullptr) return;
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::present() {
  glfwSwapBuffers(window_);
  // If the display does not make swapping wait, more pictures would only take the simulation's time.
  const double spare = presented_ + kShortestPicture - glfwGetTime();
  if (spare > 0.0) {
    glfwWaitEventsTimeout(spare);
  } else {
    glfwPollEvents();
  }
  presented_ = glfwGetTime();
}

}  // namespace weft::viewer
