#pragma once

#include <string>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/scenes/shapes/shapes.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {

/// A shape of a scene in the frame of Bullet's body: round shapes of a scene stand along their y
/// axis, a plane's normal is its y axis, and Bullet's need not.
struct PlacedShape {
  scenes::Shape shape;
  Vector3<double> position{0, 0, 0};  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Throws InvalidArgument, which begins with `body`, for a shape that a scene does not have.
[[nodiscard]] PlacedShape placed_shape(const btCollisionShape& shape, const std::string& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
