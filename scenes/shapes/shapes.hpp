#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp, tests/engines/bullet/bullet_shapes_test.cpp.

#include <array>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <weft/core/types.hpp>

namespace weft::scenes {

/// The shapes of rigid colliders, in the collider's own frame. Capsule, cylinder and cone stand
/// along its y axis, their middle at its origin.

struct SphereShape {
  double radius;  ///< [m]
};
struct BoxShape {
  Vector3<double> half_extents;  ///< [m]
};
/// The half space below the plane through the collider's position with its local y axis as normal.
struct PlaneShape {};
struct CapsuleShape {
  double radius;  ///< [m]
  double height;  ///< [m] of the cylinder between the caps: the whole is 2 radius longer
};
struct CylinderShape {
  double radius;  ///< [m]
  double height;  ///< [m]
};
/// Its base at y = -height / 2, its tip at +height / 2.
struct ConeShape {
  double radius;  ///< [m] of the base
  double height;  ///< [m]
};
/// The smallest convex solid around the points.
struct ConvexHullShape {
  Matrix3X<double> points;  ///< 3 x n [m], n >= 4, not all in one plane
};

/// What a compound is made of.
using ConvexShape =
    std::variant<SphereShape, BoxShape, CapsuleShape, CylinderShape, ConeShape, ConvexHullShape>;

/// A surface of triangles, solid behind their fronts. It is closed, or its open border is out of
/// reach: behind an open surface everything nearby is inside.
struct MeshShape {
  Matrix3X<double> points;  ///< 3 x n [m]
  Triangles triangles;      ///< 3 x t, counter-clockwise seen from outside
};

struct CompoundPart {
  ConvexShape shape;
  Vector3<double> position{0, 0, 0};  ///< [m] in the collider's frame
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};
/// The union of its parts.
struct CompoundShape {
  std::vector<CompoundPart> parts;
};

/// Ground y = height(x, z) over the rectangle |x| <= size[0] / 2, |z| <= size[1] / 2, solid below.
/// Each cell is two triangles, divided from its corner (-x, -z) to its corner (+x, +z).
struct HeightFieldShape {
  std::array<double, 2> size;  ///< [m] along x and z
  Eigen::MatrixXd heights;     ///< [m]; row = along z, column = along x; at least 2 x 2
};

using Shape = std::variant<SphereShape, BoxShape, PlaneShape, CapsuleShape, CylinderShape,
                           ConeShape, ConvexHullShape, MeshShape, CompoundShape, HeightFieldShape>;

[[nodiscard]] inline Shape as_shape(const ConvexShape& shape) {
  return std::visit([](const auto& one) { return Shape(one); }, shape);
}

}  // namespace weft::scenes
