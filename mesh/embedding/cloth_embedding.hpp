#pragma once

// Tested by tests/mesh/embedding/cloth_embedding_test.cpp, tests/mesh/embedding/torn_embedding_test.cpp.

#include <optional>
#include <vector>

#include <weft/mesh/embedding/bound_point.hpp>
#include <weft/mesh/embedding/drawn_mesh.hpp>
#include <weft/mesh/embedding/surface_frames.hpp>

namespace weft {

struct EmbeddingOptions {
  /// [m], > 0: a vertex that is farther from the cloth at rest is an error; none: any distance will do.
  std::optional<double> max_distance = std::nullopt;
  /// [m], > 0: connected pieces with a diagonal of at most this length, as buttons and buckles, turn with the cloth below them and keep their
  /// shape; none: everything bends.
  std::optional<double> rigid_pieces = std::nullopt;
};

struct EmbeddingReport {
  double largest_distance = 0.0;  ///< of a vertex from the cloth at rest [m]
  int farthest_vertex = 0;
  int num_rigid_pieces = 0;
};

/// A cloth at one time, as what is drawn needs it.
struct ClothPose {
  Matrix3X<double> positions;        ///< of nodes, 3 x n [m]
  Matrix3X<double> frames;           ///< of nodes, 3 x 3n [-]
  Matrix3X<double> piece_positions;  ///< of rigid pieces, 3 x p [m]
  Matrix3X<double> piece_rotations;  ///< of rigid pieces, 3 x 3p [-]
};

/// A vertex of the drawn mesh. The directions are unit vectors, or 0 where the cloth has collapsed to a line.
struct DrawnVertex {
  Vector3<double> position;  ///< [m]
  Vector3<double> normal;    ///< [-]
  Vector3<double> tangent;   ///< [-]; 0 if the mesh has no tangents
};

/// A fine drawn mesh led by a coarse cloth (BoundPoint has the method). At rest every vertex is where the drawn mesh has it, and a
/// cloth that moves as a rigid body moves it so, to rounding. Vertices of nodes that are not finite are not finite.
///
/// const functions may run in any number of threads at once; they allocate nothing.
class ClothEmbedding {
 public:
  /// rest_positions: 3 x n [m]; triangles: 3 x t. Throws InvalidArgument as check_drawn_mesh(), for a cloth without triangles or with one
  /// that has no area or names no node, rest positions that are not finite, options out of their domain and vertices beyond
  /// max_distance.
  ClothEmbedding(ConstMatrix3XRef<double> rest_positions, const Triangles& triangles,
                 const DrawnMesh& drawn, const EmbeddingOptions& options = {});

  [[nodiscard]] const EmbeddingReport& report() const { return report_; }
  [[nodiscard]] int num_nodes() const { return frames_.num_nodes(); }
  [[nodiscard]] int num_vertices() const { return static_cast<int>(bound_.size()); }
  /// Triangles of the drawn mesh, 3 x t.
  [[nodiscard]] const Triangles& drawn_triangles() const { return drawn_triangles_; }
  /// Vertices of the DrawnMesh that the vertices beyond its number are copies of: a tear needs them.
  [[nodiscard]] const std::vector<int>& copied_vertices() const { return copied_; }
  /// The vertex of the DrawnMesh that a vertex is, or is a copy of.
  [[nodiscard]] int original(int vertex) const;
  /// Node of the cloth that has most to say about a vertex.
  [[nodiscard]] int nearest_node(int vertex) const;

  /// Room for a pose. Allocates.
  [[nodiscard]] ClothPose make_pose() const;
  /// Fills a pose of make_pose(). positions: of all nodes, 3 x num_nodes() [m].
  void set_pose(ConstMatrix3XRef<double> positions, ClothPose& pose) const;
  /// The same where pose.positions has been filled by the caller.
  void update_pose(ClothPose& pose) const;
  /// A vertex in a pose that has been filled.
  [[nodiscard]] DrawnVertex vertex(const ClothPose& pose, int vertex) const;

  /// The cloth has torn: the same triangles with other nodes, num_nodes of them, as a Tear has them; of earlier tears everything is in
  /// them. A drawn triangle that reached across the tear stays whole on the side that has most of its corners, and
  /// the others become copies that this side leads. Poses have to be made anew. Throws InvalidArgument for another
  /// number of triangles or nodes that are not there.
  void follow_tear(const Triangles& triangles, int num_nodes);

 private:
  struct RigidPiece {
    BoundPoint anchor;
    Matrix3<double> axes;  ///< at rest: normal, tangent and their product
  };
  void bind_vertices(const FootPoints& feet, const DrawnMesh& drawn);
  void bind_pieces(const FootPoints& feet, const DrawnMesh& drawn, double largest);
  void check_distances(const DrawnMesh& drawn, const EmbeddingOptions& options);
  [[nodiscard]] Eigen::Vector3i nodes_of(const BoundPoint& point) const {
    return frames_.triangles().col(point.triangle);
  }
  [[nodiscard]] BoundPoint bound_beside(int vertex, int triangle) const;

  Matrix3X<double> rest_positions_;  ///< of the whole cloth
  Matrix3X<double> rest_normals_;
  Triangles whole_triangles_;
  SurfaceFrames frames_;
  Triangles whole_drawn_;  ///< before the first tear
  Triangles drawn_triangles_;
  Matrix3X<double> drawn_positions_;
  std::vector<BoundPoint>
      bound_;  ///< of each vertex; column 0 of the arms of a rigid piece's: from its middle
  std::vector<int> piece_of_;  ///< of each vertex; -1: none
  std::vector<RigidPiece> pieces_;
  Matrix3X<double> normals_;   ///< of vertices at rest
  Matrix3X<double> tangents_;  ///< likewise; empty: none
  std::vector<int> copied_;
  EmbeddingReport report_;
};

}  // namespace weft
