#pragma once

#include <filesystem>
#include <string>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::validation {

/// The name of a recording among the engines of a case.
inline constexpr const char* kRecordingEngine = "recording";

/// A recording that stands in for an engine: what it holds is judged, whoever has computed it.
struct RecordedResult {
  std::filesystem::path path;
  /// The recording's own, until the case is found; then the case's, by which everything is measured.
  scenes::Scene scene;
  scenes::StoredPrecision precision = scenes::StoredPrecision::kFloat64;
  std::string judged_as = "bullet_weft";  ///< the engine whose bounds hold for it
};

/// Reads what a RecordedResult says of a recording. @throws Error that names the file.
[[nodiscard]] RecordedResult recorded_result(const std::filesystem::path& path);

/// Whether two scenes ask the same of an engine: bodies, laws, colliders, gravity. Names of scenes, steps, durations, settings of single
/// engines, cameras and appearances do not count.
[[nodiscard]] bool ask_the_same(const scenes::Scene& a, const scenes::Scene& b);

/// Looks at every frame of the recording before anything is run: whether it can be compared with a run of the scene, frame by frame and
/// node by node.
/// @throws InvalidArgument that names file, frame, time, body, value and what was expected, for other bodies and numbers of nodes, for a
/// cloth that is torn, for frames at other times than the scene's, and for a collider that stands still or is led and is elsewhere than
/// the scene has it.
void check_frames(const scenes::RecordingReader& reader, const std::string& file,
                  const scenes::Scene& scene);

}  // namespace weft::validation
