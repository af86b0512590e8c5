#include <weft/validation/metrics/distance/shape_distance.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <variant>
#include <vector>

#include <weft/scenes/shapes/shape_surface.hpp>
#include <weft/validation/metrics/distance/mesh_distance.hpp>

namespace weft::validation {
namespace {

using Distance = std::function<double(const Vector3<double>&)>;

double box_distance(const Vector3<double>& half_extents, const Vector3<double>& point) {
  const Vector3<double> beyond = point.cwiseAbs() - half_extents;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

/// Distance from the axis, and height.
std::array<double, 2> turned(const Vector3<double>& point) {
  return {std::hypot(point.x(), point.z()), point.y()};
}

double capsule_distance(const scenes::CapsuleShape& s, const Vector3<double>& point) {
  Vector3<double> from_axis = point;
  from_axis.y() -= std::clamp(point.y(), -0.5 * s.height, 0.5 * s.height);
  return from_axis.norm() - s.radius;
}

double cylinder_distance(const scenes::CylinderShape& s, const Vector3<double>& point) {
  const auto [axis_distance, height] = turned(point);
  const double side = axis_distance - s.radius;
  const double end = std::abs(height) - 0.5 * s.height;
  return std::hypot(std::max(side, 0.0), std::max(end, 0.0)) + std::min(std::max(side, end), 0.0);
}

/// In the half plane through the axis the cone is a triangle.
double cone_distance(const scenes::ConeShape& s, const Vector3<double>& point) {
  const auto [axis_distance, height] = turned(point);
  const double low = -0.5 * s.height;
  const auto to_segment = [&, r = axis_distance, y = height](double r0, double y0, double r1,
                                                             double y1) {
    const double dr = r1 - r0;
    const double dy = y1 - y0;
    const double t = std::clamp(((r - r0) * dr + (y - y0) * dy) / (dr * dr + dy * dy), 0.0, 1.0);
    return std::hypot(r - r0 - t * dr, y - y0 - t * dy);
  };
  const double distance =
      std::min(to_segment(0, low, s.radius, low), to_segment(s.radius, low, 0, -low));
  const bool is_inside =
      height > low && axis_distance * s.height < s.radius * (0.5 * s.height - height);
  return is_inside ? -distance : distance;
}

Distance distance_to(const scenes::Shape& shape);

struct MakeDistance {
  Distance operator()(const scenes::SphereShape& s) const {
    return [s](const Vector3<double>& x) { return x.norm() - s.radius; };
  }
  Distance operator()(const scenes::BoxShape& s) const {
    return [s](const Vector3<double>& x) { return box_distance(s.half_extents, x); };
  }
  Distance operator()(const scenes::PlaneShape&) const {
    return [](const Vector3<double>& x) { return x.y(); };
  }
  Distance operator()(const scenes::CapsuleShape& s) const {
    return [s](const Vector3<double>& x) { return capsule_distance(s, x); };
  }
  Distance operator()(const scenes::CylinderShape& s) const {
    return [s](const Vector3<double>& x) { return cylinder_distance(s, x); };
  }
  Distance operator()(const scenes::ConeShape& s) const {
    return [s](const Vector3<double>& x) { return cone_distance(s, x); };
  }
  Distance operator()(const scenes::ConvexHullShape& s) const {
    return MeshDistance(scenes::hull_surface(s));
  }
  Distance operator()(const scenes::MeshShape& s) const { return MeshDistance(s); }
  Distance operator()(const scenes::HeightFieldShape& s) const {
    // Beside the field there is no ground, however low a point lies.
    return [ground = MeshDistance(scenes::height_field_surface(s)),
            size = s.size](const Vector3<double>& x) {
      const bool is_beside = 2 * std::abs(x.x()) > size[0] || 2 * std::abs(x.z()) > size[1];
      const double distance = ground(x);
      return is_beside ? std::abs(distance) : distance;
    };
  }
  Distance operator()(const scenes::CompoundShape& s) const {
    std::vector<Distance> parts;
    for (const scenes::CompoundPart& part : s.parts) {
      parts.push_back([one = distance_to(scenes::as_shape(part.shape)), at = part.position,
                       turn = part.orientation.conjugate()](const Vector3<double>& x) {
        return one(turn * Vector3<double>(x - at));
      });
    }
    return [parts](const Vector3<double>& x) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Distance& part : parts) nearest = std::min(nearest, part(x));
      return nearest;
    };
  }
};

Distance distance_to(const scenes::Shape& shape) {
  return std::visit(MakeDistance{}, shape);
}

}  // namespace

struct ShapeDistance::Impl {
  Distance distance;
};

ShapeDistance::ShapeDistance(const scenes::Shape& shape)
    : impl_(std::make_unique<Impl>(Impl{distance_to(shape)})) {}
ShapeDistance::~ShapeDistance() = default;
ShapeDistance::ShapeDistance(ShapeDistance&&) noexcept = default;
ShapeDistance& ShapeDistance::operator=(ShapeDistance&&) noexcept = default;

double ShapeDistance::operator()(const Vector3<double>& point) const {
  return impl_->distance(point);
}

}  // namespace weft::validation
