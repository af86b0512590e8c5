#pragma once

// Tested by tests/viewer/window_test.py.

#include <memory>
#include <string>

#include <weft/playback/video/video_encoder.hpp>
#include <weft/viewer/ui/stage.hpp>

namespace weft::viewer {

/// A film of what the window shows, as long as the view state asks for it: an MP4 file in real time, made by ffmpeg.
class WindowFilm {
 public:
  /// After every picture of the window, seconds [s] after the one before.
  void follow(Session& session, Stage& stage, double seconds);
  /// Writes what there is, if a film is under way.
  void finish(Session& session);

 private:
  void add(const scenes::Image& picture);

  std::unique_ptr<scenes::VideoEncoder> encoder_;
  scenes::Image last_;
  double time_ = 0.0;  ///< [s] of the film
  int num_images_ = 0;
};

}  // namespace weft::viewer
