#pragma once

// Tested by tests/playback/exchange/gltf/gltf_export_test.cpp, tests/playback/exchange/gltf/gltf_export_check.py.

#include <optional>

#include <weft/playback/exchange/gltf/glb_writer.hpp>

namespace weft::scenes {

/// The one animation of a glTF document, with a key for every frame of a recording.
class GltfAnimation {
 public:
  /// times: of the frames [s], ascending. writer must outlive it.
  GltfAnimation(GlbWriter& writer, Eigen::RowVectorXf times);

  /// Moves a node, or its morph weights. path: "translation", "rotation", "weights", of glTF. keys: a column for each frame.
  void add(int node, const char* path, const Eigen::MatrixXf& keys);
  /// Puts the animation into the document, if anything moves.
  void finish();

 private:
  GlbWriter& writer_;
  Eigen::RowVectorXf times_;
  std::optional<int> times_accessor_;
  GltfJson samplers_ = GltfJson::array();
  GltfJson channels_ = GltfJson::array();
};

}  // namespace weft::scenes
