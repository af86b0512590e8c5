#pragma once

// Tested by tests/bridge/contact/surface/convex_outline_test.cpp.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <weft/core/eigen_alignment.hpp>

namespace weft::bridge {

using PlanePoint = Eigen::Vector2d;
using Polygon = std::vector<PlanePoint>;

/// A rectangle along the axes.
struct PlaneBox {
  PlanePoint low, high;

  [[nodiscard]] static PlaneBox nowhere() {
    constexpr double kFar = std::numeric_limits<double>::max();
    return {PlanePoint(kFar, kFar), PlanePoint(-kFar, -kFar)};
  }
  void include(const PlanePoint& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  [[nodiscard]] bool contains(const PlaneBox& other) const {
    return (low.array() <= other.low.array()).all() && (high.array() >= other.high.array()).all();
  }
  [[nodiscard]] bool meets(const PlaneBox& other) const {
    return (low.array() <= other.high.array()).all() && (high.array() >= other.low.array()).all();
  }
};

/// Twice the area of a triangle, negative if it runs clockwise [m^2].
[[nodiscard]] inline double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  const PlanePoint first = b - a;
  const PlanePoint second = c - a;
  return first.x() * second.y() - first.y() * second.x();
}

/// Returns the area of a polygon [m^2], >= 0.
[[nodiscard]] inline double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    twice += turn(polygon[0], polygon[i - 1], polygon[i]);
  return std::abs(twice) / 2;
}

/// Returns the part of a convex polygon in a rectangle (Sutherland and Hodgman 1974).
[[nodiscard]] inline Polygon clipped(Polygon polygon, const PlaneBox& box) {
  for (int side = 0; side < 4; ++side) {
    const int axis = side / 2;
    const bool is_low = side % 2 == 0;
    const double limit = is_low ? box.low[axis] : box.high[axis];
    const auto depth = [&](const PlanePoint& p) {
      return is_low ? p[axis] - limit : limit - p[axis];
    };
    Polygon rest;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const PlanePoint& from = polygon[i];
      const PlanePoint& to = polygon[(i + 1) % polygon.size()];
      const double start = depth(from);
      const double end = depth(to);
      if (start >= 0) rest.push_back(from);
      if ((start < 0) != (end < 0)) rest.push_back(from + start / (start - end) * (to - from));
    }
    polygon = std::move(rest);
  }
  return polygon;
}

/// Returns the convex hull of some points, counterclockwise (Andrew 1979).
[[nodiscard]] inline Polygon convex_hull(std::vector<PlanePoint> points) {
  std::sort(points.begin(), points.end(), [](const PlanePoint& a, const PlanePoint& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  if (points.size() < 3) return points;
  Polygon hull;
  const auto add = [&](const PlanePoint& point, std::size_t least) {
    while (hull.size() >= least + 2 && !(turn(hull[hull.size() - 2], hull.back(), point) > 0))
      hull.pop_back();
    hull.push_back(point);
  };
  for (const PlanePoint& point : points) add(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) add(*point, lower);
  hull.pop_back();
  return hull;
}

}  // namespace weft::bridge
