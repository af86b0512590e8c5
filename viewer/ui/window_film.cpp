#include <weft/viewer/ui/window_film.hpp>

#include <cstdio>
#include <filesystem>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/scenes/output/output_file.hpp>

namespace weft::viewer {
namespace {

constexpr double kFrameRate = 25.0;  // [1/s]

std::string free_film_name() {
  for (int number = 1;; ++number) {
    std::string name = "weft-view-" + std::to_string(number) + ".mp4";
    if (!std::filesystem::exists(name)) return name;
  }
}

/// H.264 wants even sizes: without the last column or row.
scenes::Image even(const scenes::Image& image) {
  scenes::Image result{image.width / 2 * 2, image.height / 2 * 2, {}};
  for (int y = 0; y < result.height; ++y) {
    const auto row = image.rgb.begin() + std::ptrdiff_t{3} * y * image.width;
    result.rgb.insert(result.rgb.end(), row, row + std::ptrdiff_t{3} * result.width);
  }
  return result;
}

}  // namespace

void WindowFilm::follow(Session& session, Stage& stage, double seconds) {
  ViewState& view = session.view();
  if (!view.is_filming) return finish(session);
  try {
    scenes::Image picture = even(stage.read_window());
    if (!encoder_) {
      encoder_ = std::make_unique<scenes::VideoEncoder>(
          scenes::VideoFormat{.container = scenes::VideoFormat::Container::kMp4,
                              .width = picture.width,
                              .height = picture.height,
                              .frame_rate = kFrameRate});
      time_ = 0.0;
      num_images_ = 0;
    } else if (picture.width != last_.width || picture.height != last_.height) {
      view.is_filming = false;
      finish(session);
      session.tell(session.message() + "; it ends here, because the window has got another size");
      return;
    } else {
      time_ += seconds;
    }
    // The picture before was seen until now.
    while (num_images_ > 0 && num_images_ < static_cast<int>(time_ * kFrameRate)) add(last_);
    last_ = std::move(picture);
    if (num_images_ <= static_cast<int>(time_ * kFrameRate)) add(last_);
  } catch (const Error& error) {
    encoder_.reset();
    view.is_filming = false;
    session.tell(error.what());
  }
}

void WindowFilm::add(const scenes::Image& picture) {
  encoder_->add(picture);
  ++num_images_;
}

void WindowFilm::finish(Session& session) {
  if (!encoder_) return;
  const std::unique_ptr<scenes::VideoEncoder> encoder = std::move(encoder_);
  const std::string path = free_film_name();
  try {
    output::write_file(path, scenes::kMp4Kind, encoder->finish());
    char text[64];
    std::snprintf(text, sizeof(text), " (%.1f s)", num_images_ / kFrameRate);
    session.tell("saved " + path + text);
  } catch (const Error& error) {
    session.tell(error.what());
  }
}

}  // namespace weft::viewer
