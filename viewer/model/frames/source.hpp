#pragma once

// Tested by tests/viewer/session_test.cpp.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/recording/mark.hpp>
#include <weft/viewer/model/action.hpp>
#include <weft/viewer/model/frames/snapshot.hpp>

namespace weft::viewer {

/// A point of the plots.
struct PlotPoint {
  double time = 0.0;  ///< [s]
  Measures measures;
  double step_time = 0.0;  ///< [s] wall time
};

/// A recording that is shown, for the list of them.
struct ShownRecording {
  std::string name;
  std::optional<scenes::Rgb> color = {};  ///< of a ghost; none: it is the solid one
};

/// A live run, or recordings, that the window shows. Times are [s] of the scene.
class Source {
 public:
  virtual ~Source() = default;

  /// The scene that is drawn. The version changes with it.
  [[nodiscard]] virtual const scenes::Scene& drawn_scene() const = 0;
  [[nodiscard]] virtual int version() const = 0;
  /// The state to draw; none while it is loaded.
  [[nodiscard]] virtual SnapshotPtr shown() = 0;
  [[nodiscard]] virtual std::optional<scenes::Ghosts> ghosts() const { return std::nullopt; }

  /// The recordings that are drawn, the solid one first; empty for a live run.
  [[nodiscard]] virtual std::vector<ShownRecording> recordings() const { return {}; }

  /// Wall time [s] has gone by.
  virtual void update(double seconds) = 0;
  /// Does what concerns the source; false for any other action.
  virtual bool perform(Action action) = 0;
  /// Messages to the user since the last call; empty if there is nothing.
  [[nodiscard]] virtual std::string take_message() = 0;

  [[nodiscard]] virtual bool is_playing() const = 0;
  [[nodiscard]] virtual double speed() const = 0;
  virtual void set_speed(double speed) = 0;

  /// Frames for the timeline; the one that is shown.
  [[nodiscard]] virtual int num_frames() const = 0;
  [[nodiscard]] virtual int frame() const = 0;
  [[nodiscard]] virtual double frame_time(int frame) const = 0;
  virtual void seek(int frame) = 0;

  /// What a program has said about moments of its loop, in the order of their times.
  [[nodiscard]] virtual std::vector<scenes::Note> notes() const { return {}; }

  /// Oldest first.
  [[nodiscard]] virtual std::vector<PlotPoint> plot() const = 0;
  /// Adds what a test wants to read.
  virtual void describe(nlohmann::json& json) const = 0;
};

/// Speeds that keys and slider go through: simulated over wall time.
[[nodiscard]] double next_speed(double speed, int direction);

}  // namespace weft::viewer
