#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <weft/core/types.hpp>

namespace weft::scenes {

/// The points and faces of a Wavefront OBJ file, as they stand there. Importers of meshes weld, sort and divide; here point i
/// is the i-th line "v", because other programs' results are told apart by the number of a node.
struct ObjShape {
  Matrix3X<double> points;              ///< 3 x n, in the file's own unit and axes
  std::vector<std::vector<int>> faces;  ///< numbers of points from 0, at least three each
};

/// Reads lines "v" and "f"; lines of other kinds are left out. file: for messages.
/// @throws Error "file:line: ..." for a coordinate that is not a finite number, for a face with fewer than three corners or with a
/// point that is not there, and for a file without points.
[[nodiscard]] ObjShape read_obj_shape(std::string_view text, const std::string& file);

}  // namespace weft::scenes
