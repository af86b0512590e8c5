#pragma once

// Tested by tests/playback/exchange/gltf/gltf_export_test.cpp.

#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <weft/playback/exchange/gltf/glb_writer.hpp>
#include <weft/playback/exchange/gltf/gltf_animation.hpp>
#include <weft/playback/exchange/gltf/gltf_material.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// Places of one frame of reference in the frames of a recording.
struct PoseTrack {
  Eigen::Matrix3Xf translations;  ///< 3 x frames [m]
  Eigen::Matrix4Xf rotations;     ///< x y z w of unit quaternions, 4 x frames

  explicit PoseTrack(int num_frames);
  /// Orientations that are the same, q and -q, get the sign of the frame before: whoever interpolates them goes the short way.
  void set(int frame, const Vector3<double>& position, const Eigen::Quaterniond& orientation);
};

/// Adds a node that stands, or moves as the track says; object: what else the node has. Gives its index.
int add_posed_node(GlbWriter& writer, GltfAnimation& animation, const PoseTrack& track,
                   GltfJson object);

/// Rigid bodies of a glTF document. Those of the same shape and look share a mesh.
class GltfBodies {
 public:
  /// Both must outlive it.
  GltfBodies(GlbWriter& writer, GltfMaterials& materials)
      : writer_(writer), materials_(materials) {}
  /// Index of the mesh of a collider in its own frame. Its shape must have a surface, as all but planes have.
  int add_mesh(const Scene& scene, const Collider& collider);

 private:
  GlbWriter& writer_;
  GltfMaterials& materials_;
  std::map<std::string, int> meshes_;  ///< by vertices and materials
};

}  // namespace weft::scenes
