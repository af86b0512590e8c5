#pragma once

// Tested by tests/bridge/contact/surface/surface_distance_test.cpp.

#include <memory>
#include <unordered_map>
#include <vector>

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The signed distance of a point from the surface of a solid, and its gradient.
struct SurfaceDistance {
  double distance = 0;           ///< [m], below zero inside
  Vector3<double> out{0, 0, 0};  ///< unit vector out of the solid
};

/// The facets of a convex hull, with its scaling, in its own frame.
class HullFacets {
 public:
  static constexpr int kMostPoints = 256;  ///< above it, a search through all facets is too slow

  explicit HullFacets(const btConvexHullShape& shape);

  /// Whether the shape still has the points and the scaling that the facets were made of.
  [[nodiscard]] bool fit(const btConvexHullShape& shape) const;
  /// False for points in a plane, and for more than kMostPoints.
  [[nodiscard]] bool are_closed() const { return !facets_.empty(); }
  /// The distance of a point to the hull itself, without its margin. From reach [m] on it may be any distance that is not below reach. Any
  /// thread.
  [[nodiscard]] SurfaceDistance distance(const Vector3<double>& point, double reach) const;

 private:
  struct Facet {
    Vector3<double> normal;  ///< unit vector, out
    double offset = 0;       ///< [m]
    std::vector<Vector3<double>> corners;
  };

  std::vector<btVector3> points_;  ///< what they were made of
  std::vector<Facet> facets_;
  double size_ = 0;  ///< [m]
};

/// The facets of the hulls that were met lately.
class HullTable {
 public:
  /// Facets of the shape; nullptr if it is no hull or has no closed facets. They live while somebody
  /// asks for them at least once in kSteps steps. One thread at a time.
  [[nodiscard]] const HullFacets* find(const btCollisionShape& shape);
  /// Once a step: forgets what nobody has asked for.
  void begin_step();

 private:
  static constexpr int kSteps = 256;
  struct Entry {
    std::unique_ptr<HullFacets> facets;
    int last_use = 0;
  };
  std::unordered_map<const btCollisionShape*, Entry> entries_;  ///< in no order; only looked up
  int step_ = 0;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
