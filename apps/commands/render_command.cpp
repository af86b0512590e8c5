#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/camera_preset.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/montage.hpp>
#include <weft/playback/video/video_encoder.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "apps/app.hpp"
#include "apps/film/film.hpp"
#include "apps/film/film_times.hpp"
#include "apps/progress/partial_note.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/quantity_option.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

/// Duration of a film in which nothing but the camera moves, unless --duration says otherwise. [s]
constexpr double kTurnDuration = 6.0;

struct RenderCommandOptions {
  std::string recording;
  std::string beside;
  std::string output;
  std::string video;
  std::vector<std::string> styles = {"shaded"};
  std::string time;
  std::vector<std::string> times;
  int columns = 0;
  std::string size;
  bool all = false;
  std::string camera = "scene";
  bool turntable = false;
  std::string frame_rate;
  std::string duration;
  double speed = 1.0;
  scenes::RenderOptions render;
};

void read_size(const std::string& text, scenes::RenderOptions& options) {
  if (text.empty()) return;
  const std::size_t cross = text.find('x');
  const auto number = [&](const std::string& part, int& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size();
  };
  if (cross == std::string::npos || !number(text.substr(0, cross), options.width) ||
      !number(text.substr(cross + 1), options.height)) {
    throw InvalidArgument(fmt::format("--size {}: expected pixels such as 960x540", text));
  }
}

void check_options(const RenderCommandOptions& options) {
  const int choices = int{options.all} + int{!options.time.empty()} + int{!options.times.empty()};
  if (choices > 1) {
    throw InvalidArgument("--time, --times, --all: expected at most one of them");
  }
  const bool is_single = options.styles.size() == 1 && options.beside.empty();
  if (options.all && !is_single) {
    throw InvalidArgument("--all with several styles or recordings: expected one --style");
  }
  const bool is_video = !options.video.empty();
  if (is_video == !options.output.empty()) {
    throw InvalidArgument("render: expected -o OUT or --video FILE, one of them");
  }
  if (is_video && (options.all || !options.times.empty())) {
    throw InvalidArgument(
        "--video with --all or --times: expected the whole recording, or one --time");
  }
  const bool has_film_option = options.turntable || !options.frame_rate.empty() ||
                               !options.duration.empty() || options.speed != 1.0;
  if (!is_video && has_film_option) {
    throw InvalidArgument("--turntable, --frame-rate, --duration, --speed: expected --video too");
  }
  if (!options.duration.empty() && options.time.empty()) {
    throw InvalidArgument("--duration: expected --time too, a film is as long as its recording");
  }
}

/// The frame of --time or --times that can be drawn.
int frame_at(const NamedRecording& recording, const Shots& shots, const char* option,
             const std::string& time) {
  const double seconds = quantity_option(option, time, "s");
  const auto distance = [&](int frame) {
    return std::abs(recording.reader.frame_time(frame) - seconds);
  };
  return *std::min_element(shots.frames().begin(), shots.frames().end(),
                           [&](int a, int b) { return distance(a) < distance(b); });
}

/// Pictures side by side; a single one as it is.
scenes::Image joined(const std::vector<scenes::Image>& pictures, int columns) {
  return pictures.size() == 1 ? pictures.front() : scenes::filmstrip(pictures, columns);
}

/// One picture for every time, style and recording, side by side; columns = 0: a row for each style.
int render_strip(const RenderCommandOptions& options, const NamedRecording& recording,
                 Shots& shots) {
  const output::OutputFile output(options.output, scenes::kPictureKind);
  std::vector<int> frames;
  for (const std::string& time : options.times) {
    frames.push_back(frame_at(recording, shots, "--times", time));
  }
  if (!options.time.empty()) frames.push_back(frame_at(recording, shots, "--time", options.time));
  if (frames.empty()) frames.push_back(shots.frames().back());
  const std::size_t per_frame = static_cast<std::size_t>(shots.num_pictures());
  std::vector<scenes::Image> pictures(per_frame * frames.size());
  std::string times;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const double time = recording.reader.frame_time(frames[f]);
    times += fmt::format("{}{:.4g} s", times.empty() ? "" : ", ", time);
    std::vector<scenes::Image> moment = shots.draw(frames[f]);
    for (std::size_t k = 0; k < per_frame; ++k) {
      const bool is_named = !options.beside.empty();
      if (frames.size() > 1 && !is_named) {
        scenes::draw_label(moment[k], fmt::format("t = {:.4g} s", time));
      }
      pictures[k * frames.size() + f] = std::move(moment[k]);
    }
  }
  const int row = static_cast<int>(frames.size() == 1 ? per_frame : frames.size());
  output.write(scenes::encode_png(joined(pictures, options.columns ? options.columns : row)));
  print("{}: t = {}\n", options.output, times);
  return kOk;
}

/// A file for every frame, all looked at before the first is drawn.
std::vector<output::OutputFile> frame_files(const std::filesystem::path& folder, int num_frames) {
  if (std::filesystem::is_symlink(folder)) {
    throw InvalidArgument(folder.string() + ": is a symbolic link, expected a folder");
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": cannot be made (" + error.message() + ")");
  std::vector<output::OutputFile> files;
  for (int frame = 0; frame < num_frames; ++frame) {
    files.emplace_back(folder / fmt::format("frame_{:05}.png", frame), scenes::kPictureKind);
  }
  return files;
}

int render_all(const RenderCommandOptions& options, Shots& shots) {
  const auto num_frames = static_cast<int>(shots.frames().size());
  const std::vector<output::OutputFile> outputs = frame_files(options.output, num_frames);
  {
    ProgressBar progress("render");
    for (int frame = 0; frame < num_frames; ++frame) {
      progress.update(static_cast<double>(frame) / num_frames);
      outputs[static_cast<std::size_t>(frame)].write(scenes::encode_png(shots.draw(frame).front()));
    }
  }
  print("{}: {} pictures\n", options.output, num_frames);
  return kOk;
}

scenes::VideoFormat::Container container_of(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".mp4") return scenes::VideoFormat::Container::kMp4;
  if (ending == ".gif") return scenes::VideoFormat::Container::kGif;
  throw InvalidArgument(
      fmt::format("--video {}: expected a name that ends with .mp4 or .gif", file));
}

/// The frames of the film, in order, and how fast they are shown.
FilmTimes film_times(const RenderCommandOptions& options, const NamedRecording& recording,
                     const Shots& shots, scenes::VideoFormat::Container container) {
  FilmRequest request;
  request.largest_default_rate = container == scenes::VideoFormat::Container::kGif ? 25.0 : 60.0;
  request.speed = options.speed;
  if (!options.frame_rate.empty()) {
    request.frame_rate = quantity_option("--frame-rate", options.frame_rate, "1/s");
  }
  if (options.time.empty()) return frames_of_film(recording.reader, shots.frames(), request);
  const double duration = options.duration.empty()
                              ? kTurnDuration
                              : quantity_option("--duration", options.duration, "s");
  return still_film(frame_at(recording, shots, "--time", options.time), duration, request);
}

int render_video(const RenderCommandOptions& options, const NamedRecording& recording,
                 Shots& shots) {
  scenes::VideoFormat format;
  format.container = container_of(options.video);
  const bool is_gif = format.container == scenes::VideoFormat::Container::kGif;
  const output::OutputFile output(options.video, is_gif ? scenes::kGifKind : scenes::kMp4Kind);
  const FilmTimes film = film_times(options, recording, shots, format.container);
  format.frame_rate = film.frame_rate;
  const scenes::Camera camera = *options.render.camera;
  std::optional<scenes::VideoEncoder> encoder;
  {
    ProgressBar progress("video");
    const std::size_t count = film.frames.size();
    std::optional<int> drawn;
    scenes::Image picture;
    for (std::size_t i = 0; i < count; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(count);
      progress.update(part);
      if (options.turntable) {
        shots.set_camera(scenes::turned_camera(camera, 2.0 * std::numbers::pi * part));
      }
      if (options.turntable || drawn != film.frames[i]) {
        const int columns = options.columns ? options.columns : shots.num_pictures();
        picture = joined(shots.draw(film.frames[i]), columns);
        drawn = film.frames[i];
      }
      if (!encoder) {
        format.width = picture.width;
        format.height = picture.height;
        encoder.emplace(format);
      }
      encoder->add(picture);
    }
    output.write(encoder->finish());
  }
  print("{}: {} frames at {:.6g} a second, {:.4g} s, {} x {} pixels\n", options.video,
        film.frames.size(), film.frame_rate,
        static_cast<double>(film.frames.size()) / film.frame_rate, format.width, format.height);
  return kOk;
}

int render(RenderCommandOptions options) {
  const scenes::RecordingReader reader(options.recording);
  const NamedRecording recording{reader, options.recording};
  read_size(options.size, options.render);
  check_options(options);
  if (reader.num_frames() == 0) throw Error(options.recording + ": has no frame to render");
  note_if_partial(reader, options.recording);
  std::optional<scenes::RecordingReader> other;
  std::optional<NamedRecording> second;
  if (!options.beside.empty()) {
    other.emplace(options.beside);
    if (other->num_frames() == 0) throw Error(options.beside + ": has no frame to render");
    note_if_partial(*other, options.beside);
    second.emplace(NamedRecording{*other, options.beside});
  }
  const double aspect_ratio =
      static_cast<double>(options.render.width) / std::max(options.render.height, 1);
  // Both recordings are seen from one place.
  options.render.camera = scenes::preset_camera(reader.scene(), options.camera, aspect_ratio);
  Shots shots(recording, second, options.styles, options.render);
  if (!options.video.empty()) return render_video(options, recording, shots);
  return options.all ? render_all(options, shots) : render_strip(options, recording, shots);
}

}  // namespace

Action add_render_command(CLI::App& parser) {
  CLI::App* command =
      parser.add_subcommand("render", "Draw a recording off-screen, without a display");
  auto options = std::make_shared<RenderCommandOptions>();
  command->add_option("RECORDING", options->recording, "Recording made by `weft run`")->required();
  command->add_option("-o,--output", options->output, "PNG to write; with --all a folder");
  command->add_option("--video", options->video,
                      "Film to write in place of a picture, FILE.mp4 or FILE.gif; needs ffmpeg");
  command
      ->add_option("--style", options->styles,
                   "How cloth looks; several, as in shaded,wireframe, side by side")
      ->delimiter(',')
      ->check(CLI::IsMember({"shaded", "wireframe", "strain", "difference"}))
      ->capture_default_str();
  command->add_option("--time", options->time,
                      "Nearest frame to this time, e.g. \"1.5 s\" (default: last)");
  command
      ->add_option("--times", options->times,
                   "Several frames in one picture, e.g. \"0 s,0.5 s,1 s\", each with its time")
      ->delimiter(',');
  command
      ->add_option("--columns", options->columns, "Of several pictures (default: a row each style)")
      ->check(CLI::Range(1, 100));
  command->add_flag("--all", options->all, "Every frame, as frame_00000.png ... in a folder");
  command->add_option("--beside", options->beside,
                      "Another recording, drawn beside the first one from the same camera; with "
                      "--style difference the distance of its nodes [mm] as colors");
  command
      ->add_option("--camera", options->camera,
                   "The scene's own, along an axis, or from above a corner")
      ->check(CLI::IsMember(
          std::vector<std::string>(scenes::kCameraPresets.begin(), scenes::kCameraPresets.end())))
      ->capture_default_str();
  command->add_flag(
      "--turntable", options->turntable,
      "The camera goes once around while the film runs; with --time nothing else moves");
  command->add_option(
      "--frame-rate", options->frame_rate,
      "Of the film, e.g. \"25 Hz\" (default: the recording's, at most 60, of a GIF 25)");
  command
      ->add_option("--speed", options->speed,
                   "1: the film lasts as long as what happens; 0.5: twice as long")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  command->add_option("--duration", options->duration,
                      "Of a film with --time, e.g. \"4 s\" (default: 6 s)");
  auto* width = command->add_option("--width", options->render.width, "[pixels]");
  auto* height = command->add_option("--height", options->render.height, "[pixels]");
  width->capture_default_str();
  height->capture_default_str();
  command->add_option("--size", options->size, "Both at once, e.g. 960x540 [pixels]")
      ->excludes(width)
      ->excludes(height);
  return [options] { return render(*options); };
}

}  // namespace weft::app
