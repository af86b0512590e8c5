#pragma once

// Tested by tests/bridge/contact/terrain_test.cpp.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <LinearMath/btTransform.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The surface of one of Bullet's concave shapes, in the shape's frame: a plane, a height field, or a mesh of triangles. Bullet
/// itself shows a soft body a slab of 6 cm to both sides of each triangle instead.
///
/// A plane and a height field are solid below, however deep. Triangles of a mesh have two sides: a node stays on the one
/// on which it begins the step, whichever way the triangle is wound. The shape's own margin thickens each of them.
class ConcaveSurface {
 public:
  struct Triangle {
    std::array<int, 2> id{};  ///< Bullet's part and index
    std::array<Vector3<double>, 3> corners;
    Vector3<double> normal;  ///< unit vector, by the order of the corners
  };

  /// Where a node may not pass: normal . x >= offset.
  struct Plane {
    Vector3<double> normal{0, 0, 0};
    double offset = 0;        ///< [m]
    std::array<int, 2> id{};  ///< of the triangle
  };

  /// Whether a shape has such a surface.
  [[nodiscard]] static bool has(const btCollisionShape& shape);
  explicit ConcaveSurface(const btCollisionShape& shape);

  /// Whether gather() may be called from several threads at once.
  [[nodiscard]] bool is_thread_safe() const { return is_thread_safe_; }

  /// The triangles that a node of this box [m] may meet in a step, in the order in which Bullet finds them. A plane has none.
  void gather(const btVector3& low, const btVector3& high, std::vector<Triangle>& triangles) const;

  /// Appends the planes that hold a node which goes from one position to another [m], given the triangles around: that of the triangle
  /// which it would pass first; otherwise, of what is nearer than reach [m] to where it ends, those of all triangles that the node is above or
  /// below, and of the edges and corners that stick out of these planes.
  void add_planes(const Vector3<double>& from, const Vector3<double>& to,
                  std::span<const Triangle> triangles, double reach,
                  std::vector<Plane>& planes) const;

 private:
  [[nodiscard]] double side_of(const Triangle& triangle, double at_start, double at_end) const;
  [[nodiscard]] std::optional<Plane> first_passed(const Vector3<double>& from,
                                                  const Vector3<double>& to,
                                                  std::span<const Triangle> triangles) const;

  const btCollisionShape* shape_;
  double margin_;  ///< the shape's own [m]
  bool is_thread_safe_ = true;
  std::optional<Plane> plane_;  ///< of a btStaticPlaneShape
  std::optional<int> up_;       ///< axis of a height field
  double top_ = 0;              ///< of the height field [m]
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
