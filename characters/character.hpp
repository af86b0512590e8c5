#pragma once

// Tested by tests/characters/skinning_test.cpp.

#include <string>
#include <vector>

#include <weft/characters/skeleton.hpp>

namespace weft::characters {

/// A surface that bones carry.
struct Part {
  std::string node;            ///< name of the node that carries it
  std::string mesh;            ///< name of the mesh
  std::string material;        ///< name of its material
  Matrix3X<double> positions;  ///< 3 x n [m] as in the file, before the skin moves them
  Triangles triangles;         ///< 3 x t, counter-clockwise seen from the front
  Eigen::Matrix4Xd colors;     ///< 4 x n [-], red, green, blue, alpha; 4 x 0: none
  /// Place of each triangle's corners in a picture, corner c of triangle t in column 3t + c, 2 x 3t
  /// [-], (0, 0) the lower left; 2 x 0: none.
  Eigen::Matrix2Xd corner_texture_coordinates;
  /// Influences of vertex i are first_influence[i] to first_influence[i + 1] - 1 in the two vectors
  /// below; their weights sum to 1.
  std::vector<int> first_influence;
  std::vector<int> influence_joint;  ///< index in joints
  std::vector<double> influence_weight;
  std::vector<int> joints;                    ///< bones
  std::vector<Eigen::Affine3d> inverse_bind;  ///< from the model's frame to that of each joint
};

/// What the file needed before it could be used; for people.
struct ImportReport {
  int num_merged_vertices = 0;        ///< at the place of another one
  int num_dropped_triangles = 0;      ///< with two corners in one place
  int num_normalized_weights = 0;     ///< vertices whose weights did not sum to 1
  double largest_weight_error = 0.0;  ///< |sum of weights - 1| of these
  std::vector<std::string> notes;     ///< one sentence each
};

/// A model from an art tool: bones, clips and the surfaces that they carry.
struct Character {
  Skeleton skeleton;
  std::vector<Clip> clips;
  std::vector<Part> parts;  ///< at most one per node and material
  ImportReport report;
};

/// Linear blend skinning: sum over influences of w frame[joint] inverse_bind[joint] p, 3 x n [m] in
/// the model's frame. frames: of all bones, from bone_frames().
[[nodiscard]] Matrix3X<double> skinned_positions(const Part& part,
                                                 const std::vector<Eigen::Affine3d>& frames);

/// Indices of the parts whose node has this name; if there is none, whose mesh; if none, whose
/// material. Throws InvalidArgument that lists the names there are.
[[nodiscard]] std::vector<int> find_parts(const Character& character, const std::string& name);

/// Which vertices are one: those in the same place of the file, or of these only those with the same
/// joints and weights, which stay together however the bones move.
enum class Weld { kSamePlace, kSameSkin };

/// Parts as one, with its vertices merged. Throws InvalidArgument for no part.
[[nodiscard]] Part merged_part(const Character& character, const std::vector<int>& parts,
                               Weld weld);

/// The clip of this name. Throws InvalidArgument that lists the names there are.
[[nodiscard]] const Clip& find_clip(const Character& character, const std::string& name);

/// Sum of the weights [-], n, that the bone of this name has on the part's vertices: how art tools
/// keep painted weights of a vertex group. Throws InvalidArgument if it is no joint of the part.
[[nodiscard]] VectorX<double> joint_weights(const Character& character, const Part& part,
                                            const std::string& bone);

}  // namespace weft::characters
