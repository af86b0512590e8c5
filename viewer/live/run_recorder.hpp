#pragma once

// Tested by tests/viewer/live/simulation_test.cpp.

#include <filesystem>
#include <memory>
#include <string>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/recording_output.hpp>

namespace weft::viewer {

/// Writes a live run to a recording: the frames that `weft run` would write.
class RunRecorder {
 public:
  /// Throws as RecordingOutput and RecordingWriter.
  RunRecorder(const std::string& path, const scenes::Scene& scene,
              const scenes::Provenance& provenance, scenes::StoredPrecision precision);
  /// Without finish() the partial recording stays, with all frames so far.
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// The file of the frames until finish().
  [[nodiscard]] const std::filesystem::path& partial() const { return output_.partial(); }

  void add_frame(const scenes::SceneState& state);
  void set_blow_up(const scenes::BlowUp& blow_up);
  void finish();

 private:
  scenes::RecordingOutput output_;
  std::unique_ptr<scenes::RecordingWriter> writer_;
};

}  // namespace weft::viewer
