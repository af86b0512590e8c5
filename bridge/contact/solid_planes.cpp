#include <weft/bridge/contact/solid_planes.hpp>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

bool SolidPlanes::has(const btCollisionShape& shape) {
  return shape.getShapeType() == SPHERE_SHAPE_PROXYTYPE ||
         shape.getShapeType() == BOX_SHAPE_PROXYTYPE;
}

SolidPlanes::SolidPlanes(const Collider& collider, btScalar margin)
    : is_ball_(collider.shape->getShapeType() == SPHERE_SHAPE_PROXYTYPE),
      margin_(static_cast<double>(margin)),
      origin_(from_bullet(collider.pose.getOrigin())) {
  for (int k = 0; k < 3; ++k) turn_.row(k) = from_bullet(collider.pose.getBasis().getRow(k));
  if (is_ball_) {
    radius_ = static_cast<double>(static_cast<const btSphereShape&>(*collider.shape).getRadius());
  } else {
    half_ = from_bullet(static_cast<const btBoxShape&>(*collider.shape).getHalfExtentsWithMargin());
  }
}

void SolidPlanes::find_ball_distance(const Vectors& points, Vectors& out, Lanes& distance) const {
  const Lanes length = (points[0].square() + points[1].square() + points[2].square()).sqrt();
  distance = length - radius_;
  const auto is_outside = length > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    out[k] = is_outside.select(points[k] / length, k == 1 ? 1.0 : 0.0);
  }
}

// Outside, the distance to the nearest point; inside, to the nearest face.
void SolidPlanes::find_box_distance(const Vectors& points, Vectors& out, Lanes& distance) const {
  Vectors beyond;
  for (std::size_t k = 0; k < 3; ++k) beyond[k] = points[k].abs() - half_[static_cast<int>(k)];
  const Lanes deepest = beyond[0].max(beyond[1]).max(beyond[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes away = (points[k] < 0).select(-beyond[k], beyond[k]);
    out[k] = (beyond[k] > 0).select(away, 0.0);
  }
  const Lanes length = (out[0].square() + out[1].square() + out[2].square()).sqrt();
  const auto is_outside = deepest > 0;
  distance = is_outside.select(length, deepest);
  Lanes is_taken = Lanes::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes is_nearest = (beyond[k] == deepest).select(1 - is_taken, 0.0);
    is_taken += is_nearest;
    const Lanes face = (points[k] < 0).select(-is_nearest, is_nearest);
    out[k] = is_outside.select(out[k] / distance, face);
  }
}

SolidPlanes::Planes SolidPlanes::at(const Vectors& positions) const {
  Vectors away;
  for (std::size_t k = 0; k < 3; ++k) away[k] = positions[k] - origin_[static_cast<int>(k)];
  Vectors local;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = turn_.col(static_cast<int>(k));
    local[k] = row[0] * away[0] + row[1] * away[1] + row[2] * away[2];
  }
  Vectors out;
  Planes planes;
  if (is_ball_) {
    find_ball_distance(local, out, planes.distance);
  } else {
    find_box_distance(local, out, planes.distance);
  }
  Vectors terms;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = turn_.row(static_cast<int>(k));
    planes.normal[k] =
        (row[0] * out[0] + row[1] * out[1] + row[2] * out[2]).template cast<btScalar>();
    // With the normal as it is rounded, so that the plane is where it should be for this position.
    terms[k] =
        planes.normal[k].template cast<double>() *
        (row[0] * local[0] + row[1] * local[1] + row[2] * local[2] + origin_[static_cast<int>(k)]);
  }
  planes.offset = terms[0] + terms[1] + terms[2] - planes.distance + margin_;
  return planes;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
