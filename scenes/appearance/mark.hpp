#pragma once

// Tested by tests/playback/rendering/meshes/mark_mesh_test.cpp, tests/scenes/recording/mark_test.cpp.

#include <string>

#include <weft/core/types.hpp>
#include <weft/scenes/appearance/appearance.hpp>

namespace weft::scenes {

enum class MarkKind { kPoints, kLines, kArrows };

/// What a program draws into one frame beside its bodies: contact points, forces, a path.
struct Mark {
  MarkKind kind = MarkKind::kPoints;
  std::string name;      ///< of all marks that mean the same
  Rgb color{};           ///< sRGB
  Matrix3X<float> from;  ///< 3 x n [m] points, or where lines and arrows begin
  Matrix3X<float> to;    ///< 3 x n [m] where they end; 3 x 0 for points
};

}  // namespace weft::scenes
