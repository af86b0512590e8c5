#pragma once

// Tested by tests/viewer/recorded/comparison_test.cpp.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/viewer/model/frames/snapshot.hpp>

namespace weft::viewer {

/// Recordings that are shown over one another: the first one solid, with its times; the others as ghosts
/// at the same time.
class Comparison {
 public:
  /// Throws Error for a file that is no recording or has no frame.
  explicit Comparison(std::vector<std::filesystem::path> paths);

  [[nodiscard]] std::size_t size() const { return readers_.size(); }
  /// The recording that is solid, counted as the paths.
  [[nodiscard]] std::size_t solid() const { return solid_; }
  [[nodiscard]] const std::filesystem::path& path() const { return paths_[solid_]; }
  [[nodiscard]] const std::filesystem::path& path(std::size_t recording) const {
    return paths_.at(recording);
  }
  /// The color of a recording as a ghost.
  [[nodiscard]] static scenes::Rgb ghost_color(std::size_t recording);
  /// Makes the next recording the solid one.
  void next();
  /// Shows or hides ghosts; a single recording has none.
  void show_ghosts(bool are_shown);
  [[nodiscard]] bool has_ghosts() const { return are_shown_ && size() > 1; }

  /// The scene that is drawn: bodies of the solid recording, then those of the ghosts that may move.
  [[nodiscard]] const scenes::Scene& drawn_scene() const { return drawn_scene_; }
  [[nodiscard]] scenes::Ghosts ghosts() const;
  [[nodiscard]] const scenes::RecordingReader& reader() const { return *readers_[solid_]; }

  [[nodiscard]] int num_frames() const { return reader().num_frames(); }
  [[nodiscard]] double frame_time(int frame) const { return reader().frame_time(frame); }
  /// The last frame that is not after a time [s].
  [[nodiscard]] int frame_at(double time) const;
  /// Whether a run may still be writing one of the recordings.
  [[nodiscard]] bool may_grow() const;
  /// Reads what has been written since, also from the file whose name a run has made whole has got. True if something has come.
  bool follow();
  /// The state that is drawn, and the measures of the solid recording. Frames that were read last are
  /// kept.
  [[nodiscard]] SnapshotPtr frame(int frame);
  /// Measures of frames that have not been asked for, for plots, within a wall time [s]. True once all
  /// are there.
  bool measure_more(double seconds);
  /// The figures of each frame of the solid recording; none where it was not measured yet.
  [[nodiscard]] const std::vector<std::optional<Measures>>& measures() const { return measures_; }
  /// Those of the solid recording.
  [[nodiscard]] const std::vector<scenes::Note>& notes() const { return notes_; }

 private:
  /// When a file and its log were changed last, and their sizes.
  struct Stamp {
    std::array<std::filesystem::file_time_type, 2> times{};
    std::array<std::uintmax_t, 2> sizes{};
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  [[nodiscard]] static Stamp stamp_of(const std::filesystem::path& path);
  void rebuild();
  bool follow(std::size_t recording);

  std::vector<std::filesystem::path> paths_;
  std::vector<Stamp> stamps_;
  std::vector<char> are_gone_;  ///< flags: neither the partial recording is there nor the whole one
  std::vector<std::unique_ptr<scenes::RecordingReader>> readers_;
  std::size_t solid_ = 0;
  bool are_shown_ = true;
  scenes::Scene drawn_scene_;
  std::vector<std::vector<std::size_t>> moving_;  ///< colliders of each recording that may move
  std::unique_ptr<Meter> meter_;                  ///< of the solid recording
  std::vector<std::optional<Measures>> measures_;
  std::size_t num_measured_ = 0;
  std::vector<scenes::Note> notes_;
  SnapshotPtr last_;
  int last_frame_ = -1;
};

}  // namespace weft::viewer
