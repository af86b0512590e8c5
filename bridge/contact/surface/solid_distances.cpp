#include <weft/bridge/contact/surface/solid_distances.hpp>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

bool SolidDistances::has(const btCollisionShape& shape) {
  return shape.getShapeType() == SPHERE_SHAPE_PROXYTYPE ||
         shape.getShapeType() == BOX_SHAPE_PROXYTYPE;
}

SolidDistances::SolidDistances(const Collider& collider)
    : is_ball_(collider.shape->getShapeType() == SPHERE_SHAPE_PROXYTYPE),
      origin_(from_bullet(collider.pose.getOrigin())) {
  for (int k = 0; k < 3; ++k) turn_.row(k) = from_bullet(collider.pose.getBasis().getRow(k));
  if (is_ball_) {
    radius_ = static_cast<double>(static_cast<const btSphereShape&>(*collider.shape).getRadius());
  } else {
    half_ = from_bullet(static_cast<const btBoxShape&>(*collider.shape).getHalfExtentsWithMargin());
  }
}

void SolidDistances::find_from_ball(Distances& found) const {
  const Vectors& points = found.points;
  const Lanes length = (points[0].square() + points[1].square() + points[2].square()).sqrt();
  found.distance = length - radius_;
  const auto is_outside = length > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    found.out[k] = is_outside.select(points[k] / length, k == 1 ? 1.0 : 0.0);
  }
}

// Outside, the distance to the nearest point; inside, to the nearest face.
void SolidDistances::find_from_box(Distances& found) const {
  const Vectors& points = found.points;
  Vectors& out = found.out;
  Vectors beyond;
  for (std::size_t k = 0; k < 3; ++k) beyond[k] = points[k].abs() - half_[static_cast<int>(k)];
  const Lanes deepest = beyond[0].max(beyond[1]).max(beyond[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes away = (points[k] < 0).select(-beyond[k], beyond[k]);
    out[k] = (beyond[k] > 0).select(away, 0.0);
  }
  const Lanes length = (out[0].square() + out[1].square() + out[2].square()).sqrt();
  const auto is_outside = deepest > 0;
  found.distance = is_outside.select(length, deepest);
  Lanes is_taken = Lanes::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes is_nearest = (beyond[k] == deepest).select(1 - is_taken, 0.0);
    is_taken += is_nearest;
    // Zeros are positive, as they are for a single node.
    const Lanes face = (points[k] < 0 && is_nearest > 0).select(-1.0, is_nearest);
    out[k] = is_outside.select(out[k] / found.distance, face);
  }
}

SolidDistances::Distances SolidDistances::of(const Vectors& positions) const {
  Vectors away;
  for (std::size_t k = 0; k < 3; ++k) away[k] = positions[k] - origin_[static_cast<int>(k)];
  Distances found;
  for (std::size_t k = 0; k < 3; ++k) {
    // A row of the transpose. The order of the sum is that of Eigen's product for a single vector.
    const auto row = turn_.col(static_cast<int>(k));
    found.points[k] = row[0] * away[0] + row[1] * away[1] + row[2] * away[2];
  }
  if (is_ball_) {
    find_from_ball(found);
  } else {
    find_from_box(found);
  }
  return found;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
