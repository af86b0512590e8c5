#include <weft/bridge/contact/surface/concave_surface.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btTriangleCallback.h>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using Position = Vector3<double>;

/// By this share of a triangle a path may miss it and still counts as passing it: no gap between two of them [-].
constexpr double kSeam = 1e-9;
/// An edge that sticks out of a plane by less than this share of the reach is part of it [-].
constexpr double kFlat = 1e-3;

class Collector : public btTriangleCallback {
 public:
  explicit Collector(std::vector<ConcaveSurface::Triangle>& triangles) : triangles_(triangles) {}
  void processTriangle(btVector3* corners, int part, int index) override {
    ConcaveSurface::Triangle triangle;
    triangle.id = {part, index};
    for (int k = 0; k < 3; ++k) {
      triangle.corners[static_cast<std::size_t>(k)] = from_bullet<double>(corners[k]);
    }
    const auto& [a, b, c] = triangle.corners;
    triangle.normal = (b - a).cross(c - a);
    const double area = triangle.normal.norm();
    if (!(area > std::numeric_limits<double>::min())) return;  // an edge has neighbors that have it
    triangle.normal /= area;
    triangles_.push_back(triangle);
  }

 private:
  std::vector<ConcaveSurface::Triangle>& triangles_;
};

/// Barycentric coordinates of the projection of a position along the normal.
Vector3<double> coordinates(const ConcaveSurface::Triangle& triangle, const Position& position) {
  const auto& [a, b, c] = triangle.corners;
  const double area = triangle.normal.dot((b - a).cross(c - a));
  const double of_a = triangle.normal.dot((c - b).cross(position - b)) / area;
  const double of_b = triangle.normal.dot((a - c).cross(position - c)) / area;
  return {of_a, of_b, 1 - of_a - of_b};
}

Position nearest_on_segment(const Position& position, const Position& a, const Position& b) {
  const Position along = b - a;
  const double length2 = along.squaredNorm();
  if (!(length2 > 0)) return a;
  return a + std::clamp((position - a).dot(along) / length2, 0.0, 1.0) * along;
}

Position nearest_on_edges(const ConcaveSurface::Triangle& triangle, const Position& position) {
  Position nearest = triangle.corners[0];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Position here =
        nearest_on_segment(position, triangle.corners[k], triangle.corners[(k + 1) % 3]);
    const double distance = (position - here).squaredNorm();
    if (distance < least) {
      least = distance;
      nearest = here;
    }
  }
  return nearest;
}

/// An edge or a corner near a node.
struct Ridge {
  double distance;  ///< [m]
  Position nearest;
  Vector3<double> out;
  std::array<int, 2> id;
};

}  // namespace

bool ConcaveSurface::has(const btCollisionShape& shape) {
  const int type = shape.getShapeType();
  return shape.isConcave() && type != SDF_SHAPE_PROXYTYPE && type != EMPTY_SHAPE_PROXYTYPE;
}

ConcaveSurface::ConcaveSurface(const btCollisionShape& shape)
    : shape_(&shape), margin_(static_cast<double>(shape.getMargin())) {
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      plane_ = Plane{from_bullet<double>(plane.getPlaneNormal()).normalized(),
                     static_cast<double>(plane.getPlaneConstant()) + margin_,
                     {}};
      break;
    }
    case TERRAIN_SHAPE_PROXYTYPE: {
      up_ = static_cast<const btHeightfieldTerrainShape&>(shape).getUpAxis();
      btVector3 low;
      btVector3 high;
      shape.getAabb(btTransform::getIdentity(), low, high);
      top_ = static_cast<double>(high[*up_]);
      break;
    }
    case TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE:
      break;
    default:
      is_thread_safe_ = false;  // a GImpact mesh locks its triangles
  }
}

void ConcaveSurface::gather(const btVector3& low, const btVector3& high,
                            std::vector<Triangle>& triangles) const {
  if (plane_) return;
  btVector3 top = high;
  if (up_) top[*up_] = std::max(top[*up_], static_cast<btScalar>(top_));
  Collector collector(triangles);
  static_cast<const btConcaveShape&>(*shape_).processAllTriangles(&collector, low, top);
}

// A node of a mesh keeps the side of its start; one that begins in the triangle's own plane has the side of its end.
double ConcaveSurface::side_of(const Triangle& triangle, double at_start, double at_end) const {
  if (up_) return triangle.normal[*up_] < 0 ? -1 : 1;
  if (at_start != 0) return at_start < 0 ? -1 : 1;
  return at_end < 0 ? -1 : 1;
}

std::optional<ConcaveSurface::Plane> ConcaveSurface::first_passed(
    const Position& from, const Position& to, std::span<const Triangle> triangles) const {
  std::optional<Plane> first;
  double earliest = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : triangles) {
    const double at_start = triangle.normal.dot(from - triangle.corners[0]);
    const double at_end = triangle.normal.dot(to - triangle.corners[0]);
    const double side = side_of(triangle, at_start, at_end);
    if (side * at_start < 0 || side * at_end >= 0) continue;
    const double share = at_start / (at_start - at_end);
    if (share >= earliest) continue;
    if (coordinates(triangle, from + share * (to - from)).minCoeff() < -kSeam) continue;
    earliest = share;
    const Vector3<double> out = side * triangle.normal;
    first = Plane{out, out.dot(triangle.corners[0]) + margin_, triangle.id};
  }
  return first;
}

void ConcaveSurface::add_planes(const Position& from, const Position& to,
                                std::span<const Triangle> triangles, double reach,
                                std::vector<Plane>& planes) const {
  if (plane_) {
    if (plane_->normal.dot(to) - plane_->offset < reach) planes.push_back(*plane_);
    return;
  }
  if (const auto passed = first_passed(from, to, triangles)) {
    planes.push_back(*passed);
    return;
  }
  const std::size_t first = planes.size();
  const double near = reach + margin_;
  std::vector<Ridge> ridges;
  for (const Triangle& triangle : triangles) {
    const double height = triangle.normal.dot(to - triangle.corners[0]);
    const double side = side_of(triangle, up_ ? 0 : height, height);
    if (side * height >= near) continue;
    const Vector3<double> out = side * triangle.normal;
    if (side * height < 0) {  // in the ground: the triangle straight above
      Position above = to;
      above[*up_] += -side * height / out[*up_];
      if (!(out[*up_] > 0) || coordinates(triangle, above).minCoeff() < -kSeam) continue;
      planes.push_back({out, out.dot(triangle.corners[0]) + margin_, triangle.id});
      continue;
    }
    if (coordinates(triangle, to).minCoeff() > 0) {
      planes.push_back({out, out.dot(triangle.corners[0]) + margin_, triangle.id});
      continue;
    }
    const Position nearest = nearest_on_edges(triangle, to);
    const double distance = (to - nearest).norm();
    if (distance >= near) continue;
    ridges.push_back({distance, nearest,
                      distance > 0 ? Vector3<double>((to - nearest) / distance) : out,
                      triangle.id});
  }
  std::stable_sort(ridges.begin(), ridges.end(),
                   [](const Ridge& a, const Ridge& b) { return a.distance < b.distance; });
  for (const Ridge& ridge : ridges) {
    const bool sticks_out = std::all_of(
        planes.begin() + static_cast<std::ptrdiff_t>(first), planes.end(), [&](const Plane& plane) {
          return plane.normal.dot(ridge.nearest) - (plane.offset - margin_) > kFlat * reach;
        });
    if (!sticks_out) continue;
    planes.push_back({ridge.out, ridge.out.dot(ridge.nearest) + margin_, ridge.id});
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
