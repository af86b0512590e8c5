#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

/// Which way is up in the files, and how long one unit of theirs is. The default is what weft export writes.
struct FileAxes {
  bool is_z_up = false;  ///< as in Blender's own world: (x, y, z) of the file is (x, z, -y) here
  double length_unit = 1.0;  ///< [m], > 0
};

/// Points that move, as another program has written them.
struct ShapeSequence {
  std::string source;                     ///< "caches/cloth.pc2", for messages and the provenance
  std::vector<Matrix3X<double>> samples;  ///< 3 x n each [m], y up, all with the same n
  double frames_per_sample = 1.0;  ///< frames of the other program from one sample to the next, > 0
  /// Empty where no OBJ file says them; numbers of points from 0.
  std::vector<std::vector<int>> faces;
  std::string faces_source;                               ///< the file that says them
  StoredPrecision precision = StoredPrecision::kFloat64;  ///< the files' own
  std::string
      content_hash;  ///< XXH3-128 of the files' bytes, one file after the other, as xxh128sum prints it
};

/// A PC2 point cache. If a file of the same name with the ending .obj stands beside it, its faces come along and it must have as
/// many points.
/// @throws Error that names the file and what is wrong.
[[nodiscard]] ShapeSequence read_point_cache_sequence(const std::filesystem::path& path,
                                                      const FileAxes& axes);

/// OBJ files, one for each frame: all that end in .obj of a folder, or those that a pattern with one '*' in the file's name
/// finds. The last number in a file's name is its frame. All have the points and the faces of the first.
/// @throws Error if there are fewer than two, if a name has no number, two have the same one or the numbers are not equally spaced,
/// and if a file differs from the first in points or faces.
[[nodiscard]] ShapeSequence read_obj_sequence(const std::filesystem::path& place,
                                              const FileAxes& axes);

}  // namespace weft::scenes
