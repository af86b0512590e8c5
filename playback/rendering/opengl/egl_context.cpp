#include <weft/playback/rendering/opengl/egl_context.hpp>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <string_view>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

[[noreturn]] void fail(std::string_view what) {
  throw Error(fmt::format("off-screen OpenGL: {} (EGL error 0x{:x})", what, eglGetError()));
}

bool has_extension(EGLDisplay display, std::string_view name) {
  const char* const known = eglQueryString(display, EGL_EXTENSIONS);
  return known != nullptr && std::string_view(known).find(name) != std::string_view::npos;
}

/// One for the whole program; EGL counts contexts itself, and the end of the process ends it.
EGLDisplay open_display() {
  if (!has_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    fail("EGL knows no platform without a surface, expected Mesa's");
  }
  EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    fail("EGL opens no display without a surface");
  }
  if (!has_extension(display, "EGL_KHR_surfaceless_context") ||
      !has_extension(display, "EGL_KHR_no_config_context")) {
    fail("EGL makes no contexts without a surface and a configuration");
  }
  return display;
}

class EglContext final : public GlContext {
 public:
  explicit EglContext(GlVersion version) : version_(version), display_(open_display()) {
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) fail("EGL has no OpenGL");
    const std::array<EGLint, 7> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                              version.major,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              version.minor,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) {
      fail(
          fmt::format("version = {}.{} core profile, expected one that this EGL offers (3.3 is "
                      "enough for Weft)",
                      version.major, version.minor));
    }
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;
  ~EglContext() override {
    if (eglGetCurrentContext() == context_) {
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(display_, context_);
  }

  void make_current() override {
    // Which of its programming interfaces is meant EGL remembers for each thread.
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE ||
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      fail("EGL refused to make its context the current one");
    }
  }

  [[nodiscard]] Function find_function(const char* name) const override {
    return eglGetProcAddress(name);
  }

  [[nodiscard]] std::string description() const override {
    return fmt::format("EGL without a surface, OpenGL {}.{} core profile", version_.major,
                       version_.minor);
  }

 private:
  GlVersion version_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlContext> open_egl_context(GlVersion version) {
  return std::make_unique<EglContext>(version);
}

}  // namespace weft::scenes
