#pragma once

// Tested by tests/playback/exchange/gltf/gltf_export_test.cpp, tests/playback/exchange/gltf/gltf_export_check.py.

#include <string>
#include <string_view>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <weft/core/types.hpp>
#include <weft/scenes/output/file_kind.hpp>

namespace weft::scenes {

using GltfJson = nlohmann::ordered_json;

/// A glTF 2.0 document with its binary data, which becomes one .glb file.
class GlbWriter {
 public:
  /// The use of an accessor: vertices and indices are marked for the graphics card.
  enum class Use { kVertices, kIndices, kAnimation };

  GlbWriter();

  /// Everything but buffers, buffer views and accessors is the caller's.
  [[nodiscard]] GltfJson& root() { return root_; }
  /// Adds an object to one of the document's arrays, as "nodes", and gives its index there.
  int add(const char* array, GltfJson object);

  /// Adds single-precision numbers, a column for each element, of 1 (SCALAR) to 4 (VEC4) rows, with their range, and gives the index of the
  /// accessor.
  int add_numbers(const Eigen::Ref<const Eigen::MatrixXf>& numbers, Use use);
  /// Adds indices of vertices, of any shape, column by column.
  int add_indices(const Eigen::Ref<const Eigen::MatrixXi>& indices);
  /// Adds a PNG or JPEG file and gives the index of the image. media_type: "image/png" or "image/jpeg".
  int add_image(std::string_view bytes, const char* media_type);

  /// The whole file. Throws Error if it is larger than the 4 GB that a .glb file can have.
  [[nodiscard]] std::string bytes() const;

 private:
  int add_view(std::string_view bytes, const char* target_key, int target);
  int add_accessor(const void* values, std::size_t bytes, Use use, GltfJson accessor);

  GltfJson root_;
  std::string binary_;
};

/// A .glb file that GlbWriter made.
extern const output::FileKind kGlbKind;

}  // namespace weft::scenes
