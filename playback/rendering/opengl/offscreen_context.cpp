#include <weft/playback/rendering/opengl/offscreen_context.hpp>

#include <GL/osmesa.h>

#include <array>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// OSMesa wants a colour buffer to make a context current. Nothing is ever drawn to it: the
/// renderer owns framebuffer objects of the size that it needs.
constexpr int kBufferSize = 16;

class OsmesaContext final : public GlContext {
 public:
  explicit OsmesaContext(GlVersion version) : version_(version) {
    const std::array<int, 13> attributes = {OSMESA_FORMAT,
                                            OSMESA_RGBA,
                                            OSMESA_DEPTH_BITS,
                                            0,
                                            OSMESA_PROFILE,
                                            OSMESA_CORE_PROFILE,
                                            OSMESA_CONTEXT_MAJOR_VERSION,
                                            version.major,
                                            OSMESA_CONTEXT_MINOR_VERSION,
                                            version.minor,
                                            0};
    context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
    if (context_ == nullptr) {
      throw Error(
          fmt::format("off-screen OpenGL: version = {}.{} core profile, expected one that this "
                      "OSMesa library offers (3.3 is enough for Weft)",
                      version.major, version.minor));
    }
  }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }

  void make_current() override {
    if (OSMesaMakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, kBufferSize, kBufferSize) !=
        GL_TRUE) {
      throw Error("off-screen OpenGL: OSMesa refused to make its context the current one");
    }
  }

  [[nodiscard]] Function find_function(const char* name) const override {
    return OSMesaGetProcAddress(name);
  }

  [[nodiscard]] std::string description() const override {
    return fmt::format("OSMesa, OpenGL {}.{} core profile", version_.major, version_.minor);
  }

 private:
  GlVersion version_;
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4 * kBufferSize * kBufferSize> buffer_{};
};

}  // namespace

std::unique_ptr<GlContext> open_offscreen_context(GlVersion version) {
  return std::make_unique<OsmesaContext>(version);
}

}  // namespace weft::scenes
