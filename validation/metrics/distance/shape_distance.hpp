#pragma once

#include <memory>

#include <weft/scenes/shapes/shapes.hpp>

namespace weft::validation {

/// Signed distance from points to one shape in the shape's own frame, prepared for many questions.
/// Closed forms for sphere, box, plane, capsule, cylinder and cone; to the faces of a convex hull;
/// to the nearest triangle of a mesh and of a height field, with the sign of its pseudonormal
/// (Baerentzen and Aanaes 2005); beside a height field everything is outside. A compound has the smallest distance to one of its parts, which
/// inside two of them is not the distance to the surface of the union, but no less deep.
class ShapeDistance {
 public:
  explicit ShapeDistance(const scenes::Shape& shape);
  ~ShapeDistance();
  ShapeDistance(ShapeDistance&&) noexcept;
  ShapeDistance& operator=(ShapeDistance&&) noexcept;

  /// [m], negative inside; point in the shape's frame, finite.
  [[nodiscard]] double operator()(const Vector3<double>& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::validation
