#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <optional>
#include <string>
#include <vector>

#include <weft/core/types.hpp>

namespace weft::import {

/// A polygon of a mesh file: its part (an index of MeshReport::parts) and its number in it, from 0.
struct FaceOfFile {
  int part = 0;
  int face = 0;
};

/// A place where the surface is none, with the faces that meet there.
struct Defect {
  Vector3<double> place;  ///< [m]
  std::vector<FaceOfFile> faces;
};

/// What is in a mesh, and what is wrong with it.
struct MeshReport {
  std::vector<std::string> parts;  ///< names of those that were read
  int num_vertices = 0;            ///< in the file
  int num_faces = 0;               ///< polygons in the file
  int num_nodes = 0;               ///< of the surface
  int num_triangles = 0;           ///< of the surface
  int welded_vertices = 0;         ///< that share the node of an earlier one
  int unreferenced_vertices = 0;   ///< that no face names: left out
  int other_elements = 0;          ///< points and lines: left out
  std::vector<FaceOfFile>
      duplicate_faces;              ///< triangles with the nodes of an earlier one: left out
  std::vector<FaceOfFile> slivers;  ///< with an angle below kSliverAngle
  int boundary_edges = 0;
  int boundary_loops = 0;  ///< holes and outer rims
  double area = 0.0;       ///< [m^2]
  /// Smallest angle of a triangle [rad] and the face it is in.
  double smallest_angle = 0.0;
  FaceOfFile smallest_angle_face;

  // Any of these makes a mesh that no body can be made of.
  std::vector<FaceOfFile> collapsed_faces;  ///< two corners of a triangle are one node
  std::vector<FaceOfFile> flat_faces;       ///< triangles without area
  std::vector<Defect> branching_edges;      ///< edges of more than two triangles
  std::vector<Defect> flipped_edges;        ///< edges whose two triangles turn opposite ways
  std::vector<Defect> bow_ties;             ///< nodes that join two fans of triangles

  [[nodiscard]] bool is_closed() const { return num_triangles > 0 && boundary_edges == 0; }
  /// The first of the faults that a surface must not have, in one line; none if it has none.
  [[nodiscard]] std::optional<std::string> fault() const;
  /// The same for a surface that is only drawn.
  [[nodiscard]] std::optional<std::string> drawing_fault() const;
  /// Everything, line by line.
  [[nodiscard]] std::string text() const;
};

inline constexpr double kSliverAngle = 0.035;  ///< [rad], 2 degrees
/// Area over the square of the longest edge [-] below which a triangle is flat: its normal is lost in
/// the rounding of single-precision positions.
inline constexpr double kFlatRatio = 1e-6;

/// Triangles of nodes with the faces they come from, collapsed ones among them, as inspect() sees
/// them.
struct Soup {
  Matrix3X<double> positions;  ///< 3 x n [m]
  std::vector<Eigen::Vector3i> triangles;
  std::vector<FaceOfFile> faces;  ///< of each triangle
};

/// Fills in everything about the triangles, and takes collapsed and duplicate ones out of the soup:
/// keep gets the numbers of those that stay.
void inspect(const Soup& soup, MeshReport& report, std::vector<int>& keep);

}  // namespace weft::import
