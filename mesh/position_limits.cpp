#include <weft/mesh/position_limits.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>

namespace weft {
namespace {

/// Unit normals come from normalised sums: a few roundings; a mistake is far larger.
constexpr double kUnitTolerance = 1e-6;

void require_position_limits(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("position limits: " + message);
}

void check_size(const char* name, Eigen::Index size, Eigen::Index expected) {
  require_position_limits(size == expected, std::string(name) + " has " + std::to_string(size) +
                                                " entries, expected " + std::to_string(expected));
}

struct Ball {
  Vector3<double> center;
  double radius;
};

/// position, moved along the ray from the middle to the sphere; along otherwise if it is the middle.
Vector3<double> on_sphere(const Ball& ball, const Vector3<double>& position,
                          const Vector3<double>& otherwise) {
  const Vector3<double> arm = position - ball.center;
  const double length = arm.norm();
  if (!(length > 0)) return ball.center + ball.radius * otherwise;
  return ball.center + (ball.radius / length) * arm;
}

/// Nearest place to position of the circle in which two spheres meet. normal: from the backstop's
/// middle to the reach's.
Vector3<double> on_circle(const Ball& reach, const Ball& backstop, const Vector3<double>& normal,
                          const Vector3<double>& position) {
  const double distance = (reach.center - backstop.center).norm();
  const double height =
      (distance * distance + backstop.radius * backstop.radius - reach.radius * reach.radius) /
      (2 * distance);
  const double radius =
      std::sqrt(std::max(0.0, backstop.radius * backstop.radius - height * height));
  const Vector3<double> arm = position - backstop.center;
  Vector3<double> across = arm - normal.dot(arm) * normal;
  const double length = across.norm();
  across = length > 0 ? Vector3<double>(across / length) : normal.unitOrthogonal();
  return backstop.center + height * normal + radius * across;
}

}  // namespace

void check_position_limits(const PositionLimits& limits, int num_nodes) {
  if (limits.is_empty()) return;
  check_size("centers", limits.centers.cols(), num_nodes);
  check_size("max_distances", limits.max_distances.size(), num_nodes);
  require_position_limits(limits.centers.allFinite(), "a center is not finite");
  require_position_limits((limits.max_distances.array() >= 0).all(),
                          "a max_distance [m] is < 0, expected >= 0");
  if (limits.normals.cols() == 0) return;
  check_size("normals", limits.normals.cols(), num_nodes);
  check_size("backstop_radii", limits.backstop_radii.size(), num_nodes);
  check_size("backstop_offsets", limits.backstop_offsets.size(), num_nodes);
  const auto norms = limits.normals.colwise().norm().array();
  require_position_limits(((norms - 1).abs() < kUnitTolerance).all(), "a normal is no unit vector");
  const auto is_length = [](const VectorX<double>& v) {
    return v.allFinite() && (v.array() >= 0).all();
  };
  require_position_limits(is_length(limits.backstop_radii),
                          "a backstop_radius [m] is < 0 or not finite");
  require_position_limits(is_length(limits.backstop_offsets),
                          "a backstop_offset [m] is < 0 or not finite");
}

Vector3<double> limited_position(const PositionLimits& limits, int node,
                                 const Vector3<double>& position) {
  const Ball reach{limits.centers.col(node), limits.max_distances[node]};
  const bool has_backstop = limits.normals.cols() > 0 && limits.backstop_radii[node] > 0;
  const auto is_far = [&](const Vector3<double>& x) {
    return (x - reach.center).norm() > reach.radius;
  };
  if (!has_backstop) {
    return is_far(position) ? on_sphere(reach, position, Vector3<double>::UnitY()) : position;
  }
  const Vector3<double> normal = limits.normals.col(node);
  const double radius = limits.backstop_radii[node];
  const Ball backstop{reach.center - (limits.backstop_offsets[node] + radius) * normal, radius};
  const auto is_inside = [&](const Vector3<double>& x) {
    return (x - backstop.center).norm() < backstop.radius;
  };
  Vector3<double> result = position;
  if (is_inside(result)) result = on_sphere(backstop, result, normal);
  if (!is_far(result)) return result;
  result = on_sphere(reach, result, normal);
  // A reach that ends before the backstop begins never meets it.
  if (!is_inside(result) || reach.radius <= limits.backstop_offsets[node]) return result;
  return on_circle(reach, backstop, normal, position);
}

}  // namespace weft
