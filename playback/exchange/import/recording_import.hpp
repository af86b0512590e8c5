#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <weft/playback/exchange/import/shape_sequence.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// The "engine" in the provenance of a recording whose positions come from files of another program.
inline constexpr std::string_view kImported = "imported";

/// The motion of one body of the scene.
struct ImportedBody {
  std::string name;  ///< of a cloth, or of a collider that moves freely or with a character
  ShapeSequence shapes;
};

struct ImportOptions {
  double frame_rate = 0.0;  ///< [1/s] of the other program's frames, > 0
  /// Why the first frame is not the scene's start; empty: it must be within start_tolerance() of the scene's start.
  std::string other_start = {};
};

/// The frames that an import makes of the files, and where they come from.
struct Import {
  std::vector<SceneState> frames;  ///< bodies in the order of the scene; the first at time 0
  Provenance provenance;           ///< from what, how velocities were made, where the start differs
  StoredPrecision precision = StoredPrecision::kFloat64;  ///< the coarsest of the files
  double start_distance =
      0.0;                    ///< [m] of the node or point that is farthest from the scene's start
  int num_checked_faces = 0;  ///< bodies of which a file said the faces
};

/// Frames of the scene with the positions of the files. Velocities are differences of positions: central ones, at the two ends those
/// of a parabola through three samples (a line through two). Colliders that stand still, or follow a path of the scene, are where the
/// scene has them.
/// @throws Error or InvalidArgument that names the body, its file, the value and what was expected: for a body that is not in the scene,
/// is given twice, is missing, or needs no file; for numbers of nodes, faces and samples that do not fit; for a first frame elsewhere; for
/// a collider whose points are no rigid body; for fewer than two samples.
[[nodiscard]] Import import_states(const Scene& scene, const std::vector<ImportedBody>& bodies,
                                   const ImportOptions& options);

}  // namespace weft::scenes
