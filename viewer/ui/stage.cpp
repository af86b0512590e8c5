#include <weft/viewer/ui/stage.hpp>

#include <chrono>

#include <weft/core/error.hpp>

namespace weft::viewer {
namespace {

/// A picture that takes longer is drawn with one sample for each pixel while things move [s].
constexpr double kSlowPicture = 0.03;
/// So long must a picture stay the same before it is drawn again with all samples [s].
constexpr double kStillTime = 0.3;
constexpr int kFineSamples = 2;

double now() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Stage::Stage(Window& window)
    : window_(window), context_(window.context()), gl_(load_gl_functions(*context_)) {
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.GenTextures(1, &texture_);
}

Stage::~Stage() {
  renderer_.reset();
  gl_.DeleteFramebuffers(1, &framebuffer_);
  gl_.DeleteTextures(1, &texture_);
}

bool Stage::is_same(const Key& a, const Key& b) {
  return a.shown == b.shown && a.version == b.version && a.source == b.source &&
         a.size.width == b.size.width && a.size.height == b.size.height && a.style == b.style &&
         a.has_shadow == b.has_shadow && a.position == b.position && a.target == b.target;
}

void Stage::resize(const WindowSize& size) {
  if (size.width == size_.width && size.height == size_.height) return;
  size_ = size;
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 nullptr);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("OpenGL: the framebuffer of the window's picture is not complete");
  }
  gl_.ClearColor(0.80f, 0.83f, 0.87f, 1.0f);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  gl_.ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  drawn_.shown = nullptr;
}

void Stage::open_scene(Session& session) {
  renderer_.reset();
  renderer_ = std::make_unique<scenes::Renderer>(session.source().drawn_scene(), window_.context());
  meter_ = std::make_unique<Meter>(session.source().drawn_scene());
  strain_scale_.reset();
}

int Stage::samples_for(const Key& key) {
  if (!is_same(key, drawn_)) {
    still_since_ = now();
    return fine_time_ > kSlowPicture ? 1 : kFineSamples;
  }
  const bool is_still = now() - still_since_ > kStillTime;
  return is_still ? kFineSamples : drawn_.samples;
}

void Stage::paint(Session& session, const Key& key) {
  scenes::RenderOptions options;
  options.width = key.size.width;
  options.height = key.size.height;
  options.style = key.style;
  options.samples = key.samples;
  options.show_shadow = key.has_shadow;
  options.camera = session.view().camera;
  options.ghosts = session.source().ghosts();
  options.marks = key.shown->marks;
  scenes::ScalarField field;
  if (key.style == scenes::SurfaceStyle::kScalar) {
    const std::vector<Eigen::VectorXd> strains = meter_->strains(key.shown->state);
    strain_scale_.include(strains);
    field = strain_scale_.field(strains);
  }
  const double start = now();
  renderer_->render_into(framebuffer_, key.shown->state, options, &field);
  // The driver works later than it is asked; the time is known once a pixel has been read.
  std::uint8_t pixel[4];
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl_.ReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
  if (key.samples == kFineSamples) fine_time_ = now() - start;
}

void Stage::draw(Session& session) {
  const WindowSize size = window_.framebuffer_size();
  if (size.width < 1 || size.height < 1) return;  // minimised
  Source& source = session.source();
  if (&source != drawn_.source || source.version() != drawn_.version) open_scene(session);
  resize(size);
  Key key{source.shown(),
          source.version(),
          &source,
          size,
          session.view().style,
          session.view().has_shadow,
          session.view().camera.position,
          session.view().camera.target,
          0};
  if (key.shown) {
    key.samples = samples_for(key);
    if (!is_same(key, drawn_) || key.samples != drawn_.samples) paint(session, key);
  }
  drawn_ = key;
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.BlitFramebuffer(0, 0, size.width, size.height, 0, 0, size.width, size.height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

scenes::Image Stage::read_window() {
  const WindowSize size = window_.framebuffer_size();
  scenes::Image image{size.width, size.height, {}};
  const std::size_t row = std::size_t{3} * static_cast<std::size_t>(size.width);
  std::vector<std::uint8_t> bytes(row * static_cast<std::size_t>(size.height));
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, size.width, size.height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
  // OpenGL counts rows from below, pictures from above.
  for (int y = size.height - 1; y >= 0; --y) {
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(row) * y;
    image.rgb.insert(image.rgb.end(), from, from + static_cast<std::ptrdiff_t>(row));
  }
  return image;
}

}  // namespace weft::viewer
