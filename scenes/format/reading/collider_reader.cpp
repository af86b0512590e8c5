// Tested by tests/scenes/format/scene_file_test.cpp.

#include <array>
#include <cmath>

#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/appearance_reader.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 3> kOrientationKeys = {"axis", "angle", "quaternion"};

/// A quaternion this close to unit length is taken as it is, so that a written scene reads back to
/// the same bits. Above the rounding of a normalised one (a few 1e-16), below anything visible.
constexpr double kUnitTolerance = 1e-12;

Eigen::Quaterniond read_quaternion(const TomlValue& value) {
  const std::vector<TomlValue> parts = value.items("four numbers [w, x, y, z]", 4);
  const Eigen::Quaterniond q(parts[0].quantity("1"), parts[1].quantity("1"), parts[2].quantity("1"),
                             parts[3].quantity("1"));
  const double norm = q.norm();
  if (!std::isfinite(norm) || norm == 0)
    value.fail("has no length, expected four numbers [w, x, y, z]");
  return std::abs(norm - 1) <= kUnitTolerance ? q : q.normalized();
}

}  // namespace

Eigen::Quaterniond read_orientation(const TomlValue& value) {
  const TomlTable table = value.table("a table such as { axis = [0, 1, 0], angle = \"30 deg\" }");
  table.allow(kOrientationKeys);
  if (const auto quaternion = table.find("quaternion")) {
    if (table.has("axis") || table.has("angle")) {
      quaternion->fail("axis or angle is given too, expected either axis and angle or quaternion");
    }
    return read_quaternion(*quaternion);
  }
  const TomlValue axis_value = table.require("axis", "a vector such as [0, 1, 0]");
  const Vector3<double> axis = axis_value.vector("1");
  const double norm = axis.norm();
  if (!std::isfinite(norm) || norm == 0) {
    axis_value.fail("has no direction, expected a vector such as [0, 1, 0]");
  }
  const double angle = table.require("angle", expected_quantity("rad")).quantity("rad");
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis / norm)).normalized();
}

namespace {

/// Why a shape cannot be a dynamic body; empty if it can.
std::string_view why_fixed(const Shape& shape) {
  if (std::holds_alternative<PlaneShape>(shape)) return "a plane cannot move, expected no mass";
  if (std::holds_alternative<HeightFieldShape>(shape)) {
    return "a height field cannot move, expected no mass";
  }
  if (std::holds_alternative<MeshShape>(shape)) {
    return "a mesh has no stated inside to weigh, expected no mass, or a compound of convex shapes";
  }
  return {};
}

void read_motion(const TomlTable& table, Collider& collider) {
  if (const auto mass = table.find("mass")) {
    const std::string_view why = why_fixed(collider.shape);
    if (!why.empty()) mass->fail(std::string(why));
    collider.mass = mass->positive("kg");
  }
  if (const auto path = table.find("path")) {
    if (collider.mass) path->fail("a mass is given too, expected at most one of the two");
    if (const auto position = table.find("position")) {
      position->fail("path is given too, which says where the collider is, expected no position");
    }
    collider.path = read_path(*path);
    collider.position = PathMotion(*collider.path).position(0.0);
  }
  for (const std::string_view key : {"velocity", "angular_velocity"}) {
    const std::optional<TomlValue> value = table.find(key);
    if (value && !collider.mass) value->fail("a fixed body cannot move, expected a mass as well");
  }
  if (const auto value = table.find("velocity")) collider.velocity = value->vector("m/s");
  if (const auto value = table.find("angular_velocity")) {
    collider.angular_velocity = value->vector("rad/s");
  }
}

}  // namespace

Collider read_collider(const TomlTable& table, Keys more) {
  Collider collider;
  std::vector<std::string_view> keys = {"name",     "shape", "position", "orientation",
                                        "friction", "mass",  "velocity", "angular_velocity",
                                        "path"};
  keys.insert(keys.end(), more.begin(), more.end());
  keys.insert(keys.end(), kColliderAppearanceKeys.begin(), kColliderAppearanceKeys.end());
  collider.shape = read_shape(table, keys);
  collider.name = table.require("name", "a name such as \"ball\"").identifier();
  if (const auto value = table.find("position")) collider.position = value->vector("m");
  if (const auto value = table.find("orientation")) collider.orientation = read_orientation(*value);
  if (const auto value = table.find("friction")) collider.friction = value->non_negative("1");
  read_motion(table, collider);
  collider.appearance = read_appearance(table);
  return collider;
}

}  // namespace weft::scenes
