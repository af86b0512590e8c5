#pragma once

// Tested by tests/mesh/embedding/cloth_embedding_test.cpp.

#include <vector>

#include <weft/core/types.hpp>

namespace weft {

/// A surface that is drawn and not simulated: finer than the cloth that leads it, with thickness, seams, buttons. It may be open,
/// branch, consist of many pieces and list a vertex several times, as renderers do along seams of a texture.
struct DrawnMesh {
  Matrix3X<double> positions;      ///< 3 x v [m], where the cloth is in its rest positions
  Triangles triangles;             ///< 3 x t, vertex indices, counter-clockwise seen from outside
  Matrix3X<double> normals = {};   ///< 3 x v, unit [-]; empty: surface_normals()
  Matrix3X<double> tangents = {};  ///< 3 x v, unit [-], along u of the texture; empty: none
};

/// Throws InvalidArgument, with the number of the vertex or triangle, for a mesh without a triangle, numbers of normals and
/// tangents that do not fit, values that are not finite, normals and tangents of length 0 and triangles that name no vertex.
void check_drawn_mesh(const DrawnMesh& mesh);

/// Unit normals of vertices, the sum over the triangles around each, by area; vertices at the same place share theirs, so that a
/// seam of a texture is no crease. Zero where no triangle has an area. 3 x v [-].
[[nodiscard]] Matrix3X<double> surface_normals(ConstMatrix3XRef<double> positions,
                                               const Triangles& triangles);

/// For each vertex the first one at the same place, v.
[[nodiscard]] std::vector<int> first_at_place(ConstMatrix3XRef<double> positions);

}  // namespace weft
