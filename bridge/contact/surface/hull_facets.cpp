#include <weft/bridge/contact/surface/hull_facets.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <LinearMath/btConvexHullComputer.h>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Nearer than this share of the hull's size, a direction between two points is mostly rounding [-].
constexpr double kTouch = 1e-9;

Vector3<double> nearest_on_edge(const Vector3<double>& point, const Vector3<double>& a,
                                const Vector3<double>& b) {
  const Vector3<double> along = b - a;
  const double length2 = along.squaredNorm();
  if (!(length2 > 0)) return a;
  return a + std::clamp((point - a).dot(along) / length2, 0.0, 1.0) * along;
}

}  // namespace

HullFacets::HullFacets(const btConvexHullShape& shape) {
  const int num_points = shape.getNumPoints();
  points_.reserve(static_cast<std::size_t>(num_points));
  for (int i = 0; i < num_points; ++i) points_.push_back(shape.getScaledPoint(i));
  if (num_points < 4 || num_points > kMostPoints) return;
  btConvexHullComputer computer;
  computer.compute(&points_.front().x(), sizeof(btVector3), num_points, 0, 0);
  Vector3<double> center = Vector3<double>::Zero();
  std::vector<Vector3<double>> vertices;
  for (int i = 0; i < computer.vertices.size(); ++i) {
    // Not computer.vertices: these are rounded to a ten thousandth of the hull.
    vertices.push_back(
        from_bullet(points_[static_cast<std::size_t>(computer.original_vertex_index[i])]));
    center += vertices.back() / computer.vertices.size();
  }
  for (const Vector3<double>& vertex : vertices) {
    size_ = std::max(size_, (vertex - center).norm());
  }
  if (computer.faces.size() < 4) return;
  for (int f = 0; f < computer.faces.size(); ++f) {
    Facet facet;
    const btConvexHullComputer::Edge* const first = &computer.edges[computer.faces[f]];
    const btConvexHullComputer::Edge* edge = first;
    do {
      facet.corners.push_back(vertices[static_cast<std::size_t>(edge->getSourceVertex())]);
      edge = edge->getNextEdgeOfFace();
    } while (edge != first);
    // Newell's sum: a corner that lies on the line of its neighbors does no harm.
    facet.normal.setZero();
    Vector3<double> middle = Vector3<double>::Zero();
    for (std::size_t c = 0; c < facet.corners.size(); ++c) {
      const Vector3<double>& next = facet.corners[(c + 1) % facet.corners.size()];
      facet.normal += (facet.corners[c] - center).cross(next - center);
      middle += facet.corners[c] / static_cast<double>(facet.corners.size());
    }
    const double area = facet.normal.norm();
    if (!(area > kTouch * size_ * size_))
      continue;  // a sliver: its neighbors have the same distance
    facet.normal /= area;
    facet.offset = facet.normal.dot(middle);
    const bool is_inward = facet.offset < facet.normal.dot(center);
    if (is_inward) {
      facet.normal = -facet.normal;
      facet.offset = -facet.offset;
      std::reverse(facet.corners.begin(), facet.corners.end());
    }
    facets_.push_back(std::move(facet));
  }
  double thickness = std::numeric_limits<double>::max();
  for (const Facet& facet : facets_) {
    thickness = std::min(thickness, facet.offset - facet.normal.dot(center));
  }
  if (facets_.size() < 4 || !(thickness > kTouch * size_)) facets_.clear();
}

bool HullFacets::fit(const btConvexHullShape& shape) const {
  if (static_cast<std::size_t>(shape.getNumPoints()) != points_.size()) return false;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const btVector3 point = shape.getScaledPoint(static_cast<int>(i));
    for (int k = 0; k < 3; ++k) {
      if (point[k] != points_[i][k]) return false;
    }
  }
  return true;
}

SurfaceDistance HullFacets::distance(const Vector3<double>& point, double reach) const {
  double highest = -std::numeric_limits<double>::max();
  const Facet* nearest = nullptr;
  for (const Facet& facet : facets_) {
    const double height = facet.normal.dot(point) - facet.offset;
    if (height > highest) {
      highest = height;
      nearest = &facet;
    }
  }
  if (nearest == nullptr) return {reach, {0, 1, 0}};  // a point that is not finite has no distance
  if (highest <= 0 || highest >= reach) return {highest, nearest->normal};
  // Outside, the nearest point lies in a facet that faces the point: at the foot of its perpendicular, or on an edge.
  double least = std::numeric_limits<double>::max();
  Vector3<double> foot = Vector3<double>::Zero();
  for (const Facet& facet : facets_) {
    const double height = facet.normal.dot(point) - facet.offset;
    if (height <= 0 || height * height >= least) continue;
    bool is_over = true;
    for (std::size_t c = 0; c < facet.corners.size(); ++c) {
      const Vector3<double>& a = facet.corners[c];
      const Vector3<double>& b = facet.corners[(c + 1) % facet.corners.size()];
      if ((b - a).cross(point - a).dot(facet.normal) >= 0) continue;
      is_over = false;
      const Vector3<double> on_edge = nearest_on_edge(point, a, b);
      const double distance2 = (point - on_edge).squaredNorm();
      if (distance2 < least) {
        least = distance2;
        foot = on_edge;
      }
    }
    if (is_over) return {height, facet.normal};
  }
  const double distance = std::sqrt(least);
  if (!(distance > kTouch * size_)) return {distance, nearest->normal};
  return {distance, (point - foot) / distance};
}

const HullFacets* HullTable::find(const btCollisionShape& shape) {
  if (shape.getShapeType() != CONVEX_HULL_SHAPE_PROXYTYPE) return nullptr;
  const auto& hull = static_cast<const btConvexHullShape&>(shape);
  Entry& entry = entries_[&shape];
  entry.last_use = step_;
  // Another shape may have got the memory of one that is gone.
  if (!entry.facets || !entry.facets->fit(hull)) entry.facets = std::make_unique<HullFacets>(hull);
  return entry.facets->are_closed() ? entry.facets.get() : nullptr;
}

void HullTable::begin_step() {
  if (++step_ % kSteps != 0) return;
  std::erase_if(entries_,
                [&](const auto& entry) { return entry.second.last_use < step_ - kSteps; });
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
