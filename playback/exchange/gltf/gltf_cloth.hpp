#pragma once

// Tested by tests/playback/exchange/gltf/gltf_export_test.cpp, tests/playback/exchange/gltf/gltf_export_check.py.

#include <cstddef>
#include <functional>

#include <weft/playback/exchange/gltf/glb_writer.hpp>
#include <weft/playback/exchange/gltf/gltf_animation.hpp>
#include <weft/playback/exchange/gltf/gltf_export.hpp>
#include <weft/playback/exchange/gltf/gltf_material.hpp>
#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

/// The parts of a document that is being made; they must outlive what refers to them.
struct GltfParts {
  GlbWriter& writer;
  GltfMaterials& materials;
  GltfAnimation& animation;
};

/// The result for one cloth.
struct GltfClothNode {
  int node = 0;  ///< of the document
  GltfClothReport report;
};

/// Adds a cloth or rope as a mesh with morph targets. Its positions in all frames must be finite in single precision. Throws UnfitRecording for tears that close
/// again, and for a cloth with a drawn mesh that tears. on_frame is called for every frame that is read.
[[nodiscard]] GltfClothNode add_cloth(GltfParts parts, const RecordingReader& reader,
                                      std::size_t cloth, const GltfOptions& options,
                                      const std::function<void()>& on_frame);

}  // namespace weft::scenes
