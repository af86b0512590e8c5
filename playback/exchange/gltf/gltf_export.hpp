#pragma once

#include <functional>
#include <string>
#include <vector>

#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

struct GltfOptions {
  double error = 1e-3;    ///< [m] by which a node may be elsewhere than in the recording, > 0
  int most_targets = 64;  ///< of each cloth, >= 0
};

/// How near a cloth of the file is to the recording.
struct GltfClothReport {
  std::string name;
  int num_nodes = 0;
  int num_targets = 0;
  double largest_error = 0.0;  ///< [m] over all nodes and frames
  double rms_error = 0.0;      ///< [m] root mean square over all nodes and frames
  double normal_rms_error =
      0.0;  ///< [rad] root mean square of the angle between normals; 0 without normals
  bool is_within_error = true;  ///< largest_error is at most GltfOptions::error
};

struct GltfReport {
  std::vector<GltfClothReport> cloths;
  int num_rigid_bodies = 0;
  std::vector<std::string>
      left_out;  ///< planes, bodies that are not visible, and those without triangles and springs
};

struct GltfExport {
  std::string bytes;  ///< of the .glb file
  GltfReport report;
};

/// A recording as one binary glTF 2.0 file with one animation, whose keys are the frames at their times in single precision. A cloth is a mesh with morph targets
/// (fit_morph_targets()); one that tears has the nodes of its last frame all the time, which lie upon one another where it is still whole. Rigid bodies are meshes whose
/// nodes move; the scene's camera comes along. Lengths are in m; gravity points along -y, as glTF has it, by a turn of the node at the top if it does not so in the scene. The
/// report is in asset.extras too.
/// Throws UnfitRecording for what is not finite in single precision, for frames whose times are the same there and for tears that close again, InvalidArgument for options out of range and a
/// recording without a frame, and Error for a file that is too large.
[[nodiscard]] GltfExport export_gltf(const RecordingReader& reader, const GltfOptions& options,
                                     const std::function<void(double part)>& on_progress = {});

}  // namespace weft::scenes
