#include <weft/scenes/format/writing/shape_writer.hpp>

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/scene_words.hpp>

namespace weft::scenes {
namespace {

using Entries = std::vector<std::pair<std::string, std::string>>;  // keys and values

/// A number without unit that reads back to the same bits.
std::string number(double value) {
  if (!std::isfinite(value)) {
    throw InvalidArgument(fmt::format("write_scene: a value = {}, expected finite", value));
  }
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string length(double value) {
  (void)number(value);
  return "\"" + format_quantity(value, "m") + "\"";
}

std::string lengths(const Vector3<double>& v) {
  return fmt::format("[{}, {}, {}]", length(v.x()), length(v.y()), length(v.z()));
}

template <class Text>
std::string array(Eigen::Index count, Text text) {
  std::string result;
  for (Eigen::Index i = 0; i < count; ++i) result += (i > 0 ? ", " : "") + text(i);
  return "[" + result + "]";
}

std::string points_text(const Matrix3X<double>& points) {
  return array(points.cols(), [&](Eigen::Index i) {
    return array(3, [&](Eigen::Index axis) { return number(points(axis, i)); });
  });
}

Entries entries(const SphereShape& s) {
  return {{"radius", length(s.radius)}};
}

Entries entries(const BoxShape& s) {
  return {{"size", lengths(2.0 * s.half_extents)}};
}

Entries entries(const PlaneShape&) {
  return {};
}

template <class Round>
Entries round_entries(const Round& s) {
  return {{"radius", length(s.radius)}, {"height", length(s.height)}};
}

Entries entries(const CapsuleShape& s) {
  return round_entries(s);
}

Entries entries(const CylinderShape& s) {
  return round_entries(s);
}

Entries entries(const ConeShape& s) {
  return round_entries(s);
}

// Multiples of 1 m: the numbers keep their bits.
const std::pair<std::string, std::string> kMetres{"unit", "\"1 m\""};

Entries entries(const ConvexHullShape& s) {
  return {kMetres, {"points", points_text(s.points)}};
}

Entries entries(const MeshShape& s) {
  return {kMetres,
          {"points", points_text(s.points)},
          {"triangles", array(s.triangles.cols(), [&](Eigen::Index t) {
             return fmt::format("[{}, {}, {}]", s.triangles(0, t), s.triangles(1, t),
                                s.triangles(2, t));
           })}};
}

Entries entries(const HeightFieldShape& s) {
  return {{"size", fmt::format("[{}, {}]", length(s.size[0]), length(s.size[1]))},
          kMetres,
          {"heights", array(s.heights.rows(), [&](Eigen::Index j) {
             return array(s.heights.cols(),
                          [&](Eigen::Index i) { return number(s.heights(j, i)); });
           })}};
}

Entries entries(const CompoundShape& s);

Entries all_entries(const Shape& shape) {
  Entries all = std::visit([](const auto& one) { return entries(one); }, shape);
  all.insert(all.begin(), {"shape", fmt::format("\"{}\"", kShapeWords.at(shape.index()))});
  return all;
}

std::string part_text(const CompoundPart& part) {
  Entries all = all_entries(as_shape(part.shape));
  const Eigen::Quaterniond& q = part.orientation;
  all.emplace_back("position", lengths(part.position));
  all.emplace_back("orientation", fmt::format("{{ quaternion = [{}, {}, {}, {}] }}", number(q.w()),
                                              number(q.x()), number(q.y()), number(q.z())));
  std::string text;
  for (const auto& [key, value] : all) {
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, value);
  }
  return "{ " + text + " }";
}

Entries entries(const CompoundShape& s) {
  return {{"part", array(static_cast<Eigen::Index>(s.parts.size()), [&](Eigen::Index i) {
             return part_text(s.parts[static_cast<std::size_t>(i)]);
           })}};
}

}  // namespace

std::string shape_text(const Shape& shape) {
  std::string text;
  for (const auto& [key, value] : all_entries(shape)) text += fmt::format("{} = {}\n", key, value);
  return text;
}

}  // namespace weft::scenes
