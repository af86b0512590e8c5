#include <weft/viewer/ui/thumbnails.hpp>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/playback/rendering/start_of_scene.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/recording/recording.hpp>

namespace weft::viewer {
namespace {

struct Still {
  scenes::Scene scene;
  scenes::SceneState state;
};

Still still_of(const std::string& name) {
  if (!name.ends_with(".weftrec")) {
    scenes::Scene scene = scenes::load_scene(name);
    scenes::SceneState state = scenes::start_of_scene(scene);
    return {std::move(scene), std::move(state)};
  }
  const scenes::RecordingReader reader(name);
  if (reader.num_frames() == 0) throw Error("has no frame yet");
  return {reader.scene(), reader.frame(reader.num_frames() - 1)};
}

}  // namespace

Thumbnails::Thumbnails(Window& window) : window_(window) {
  gl_ = scenes::load_gl_functions(*window.context());
}

Thumbnails::~Thumbnails() {
  for (auto& [name, entry] : entries_) {
    if (entry.texture != 0) gl_.DeleteTextures(1, &entry.texture);
  }
}

const Thumbnails::Entry& Thumbnails::get(const std::string& name) {
  static const Entry kNotYet;
  const auto found = entries_.find(name);
  if (found != entries_.end()) return found->second;
  if (has_drawn_) return kNotYet;
  has_drawn_ = true;
  Entry entry;
  try {
    entry = draw(name);
  } catch (const std::exception& error) {
    entry.summary = error.what();
  }
  return entries_.emplace(name, std::move(entry)).first->second;
}

Thumbnails::Entry Thumbnails::draw(const std::string& name) {
  const Still still = still_of(name);
  Entry entry;
  entry.summary = still.scene.summary;
  scenes::Renderer renderer(still.scene, window_.context());
  scenes::RenderOptions options;
  options.width = 2 * kWidth;  // for screens of twice the resolution
  options.height = 2 * kHeight;
  GLuint framebuffer = 0;
  gl_.GenFramebuffers(1, &framebuffer);
  gl_.GenTextures(1, &entry.texture);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, entry.texture);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, options.width, options.height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, entry.texture, 0);
  renderer.render_into(framebuffer, still.state, options);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl_.DeleteFramebuffers(1, &framebuffer);
  return entry;
}

}  // namespace weft::viewer
