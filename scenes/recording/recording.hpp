#pragma once

// Tested by tests/scenes/recording/round_trip_test.cpp.

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <weft/scenes/recording/mark.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// How node values are stored: in the precision the engine computed them in, so that nothing is
/// lost.
enum class StoredPrecision { kFloat32, kFloat64 };

/// Frames are committed together, when there are so many of them or so many bytes, whichever comes
/// first.
struct ChunkLimits {
  int frames = 64;                  ///< >= 1
  std::size_t bytes = 1024 * 1024;  ///< uncompressed
};

/// Where a recording comes from: engine, precision, versions, compiler, flags, command line... key
/// -> text.
using Provenance = std::map<std::string, std::string>;

/// Writes a recording (SQLite database, zstd-compressed frames). Readable by others while it is
/// being written; after a crash everything up to the last committed chunk is there.
class RecordingWriter {
 public:
  /// Creates path; the scene's resolved text goes inside. Throws Error if the file exists or cannot
  /// be made.
  RecordingWriter(const std::filesystem::path& path, const Scene& scene,
                  const Provenance& provenance, StoredPrecision precision,
                  const ChunkLimits& limits = {});
  ~RecordingWriter();  ///< an unfinished recording stays readable and says that it is unfinished
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// marks: what is drawn in the frame beside its bodies. Throws InvalidArgument for other bodies than the scene's, for a time
  /// that does not grow, and as check_mark(), and adds nothing then; positions and velocities may be anything, also not finite.
  void add_frame(const SceneState& state, std::span<const Mark> marks = {});
  /// A named scalar over time, e.g. ("kinetic_energy_J", 0.5, 1.25); the value may be NaN.
  void add_metric(const std::string& name, double time, double value);
  /// What happened at some time. Throws InvalidArgument for a time that is not finite, and without a text.
  void add_note(const Note& note);
  /// Commits at once, together with the frames so far.
  void set_blow_up(const BlowUp& blow_up);
  /// Commits what was added so far; otherwise that happens chunk by chunk. Throws Error if it cannot
  /// be stored; what was committed before stays.
  void commit();

  /// How far the recording goes that a reader would find now.
  struct Committed {
    int frames = 0;
    double time = 0.0;  ///< of the last of them [s]
  };
  [[nodiscard]] Committed committed() const;
  /// Writes what is left, marks the recording finished and returns its content hash.
  std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads a recording. Throws Error that names the file for anything that is not a readable
/// recording. Sees what was committed when it was made. Not for several threads at once.
class RecordingReader {
 public:
  explicit RecordingReader(const std::filesystem::path& path);
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] const std::string& scene_text() const;  ///< resolved TOML
  [[nodiscard]] const Provenance& provenance() const;
  [[nodiscard]] StoredPrecision precision() const;
  [[nodiscard]] bool finished() const;
  [[nodiscard]] std::string content_hash()
      const;  ///< of what is stored now; equal to finish()'s when finished
  [[nodiscard]] std::optional<BlowUp> blow_up() const;

  [[nodiscard]] int num_frames() const;
  [[nodiscard]] double frame_time(int frame) const;  ///< [s]
  [[nodiscard]] SceneState frame(int frame) const;
  /// What the frame shows beside its bodies, in the order of writing.
  [[nodiscard]] std::vector<Mark> marks(int frame) const;
  [[nodiscard]] std::vector<Note> notes() const;
  [[nodiscard]] std::vector<std::string> metric_names() const;
  struct Sample {
    double time;  ///< [s]
    double value;
  };
  [[nodiscard]] std::vector<Sample> metric(const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::scenes
