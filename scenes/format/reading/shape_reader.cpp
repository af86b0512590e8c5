// Tested by tests/scenes/format/scene_file_test.cpp.

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>
#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::scenes {
namespace {

// Bullet visits every point of a hull for every sample of its distance field, and every triangle
// of a mesh becomes a solid of its own.
constexpr std::size_t kMaxHullPoints = 128;
constexpr std::size_t kMaxMeshPoints = 20'000;
constexpr std::size_t kMaxTriangles = 20'000;
constexpr std::size_t kMaxSamples = 257;  // of a height field along one side
constexpr std::size_t kMaxParts = 100;

constexpr std::array<std::string_view, 6> kConvexWords = {"sphere",   "box",  "capsule",
                                                          "cylinder", "cone", "convex_hull"};

double read_length(const TomlTable& table, std::string_view key) {
  return table.require(key, expected_quantity("m")).positive("m");
}

Vector3<double> read_half_extents(const TomlTable& table) {
  const std::string expected = "three edge lengths such as [\"1 m\", \"1 m\", \"1 m\"]";
  Vector3<double> half;
  const std::vector<TomlValue> edges = table.require("size", expected).items(expected, 3);
  for (int axis = 0; axis < 3; ++axis) {
    half[axis] = 0.5 * edges[static_cast<std::size_t>(axis)].positive("m");
  }
  return half;
}

/// Many lengths are written as plain numbers, in multiples of this length [m].
double read_unit(const TomlTable& table) {
  return table.require("unit", "a length such as \"1 m\" that the numbers are multiples of")
      .positive("m");
}

void check_count(const TomlValue& value, std::size_t count, std::size_t least, std::size_t most,
                 std::string_view what) {
  if (count >= least && count <= most) return;
  value.fail(fmt::format("has {} {}, expected {} to {}", count, what, least, most));
}

Matrix3X<double> read_points(const TomlTable& table, std::size_t least, std::size_t most) {
  const std::string expected = "an array of points such as [[0, 0, 0], [1, 0, 0]]";
  const double unit = read_unit(table);
  const TomlValue value = table.require("points", expected);
  const std::vector<TomlValue> items = value.items(expected);
  check_count(value, items.size(), least, most, "points");
  Matrix3X<double> points(3, static_cast<Eigen::Index>(items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    points.col(static_cast<Eigen::Index>(i)) = unit * items[i].vector("1");
  }
  return points;
}

ConvexHullShape read_hull(const TomlTable& table) {
  ConvexHullShape hull{read_points(table, 4, kMaxHullPoints)};
  try {
    (void)hull_surface(hull);
  } catch (const InvalidArgument& error) {
    table.require("points", "").fail(error.what());
  }
  return hull;
}

/// The surface must say on which side it is solid: each edge belongs to at most two triangles,
/// which run along it in opposite directions.
void check_edges(const MeshShape& mesh, const std::vector<TomlValue>& items) {
  std::map<std::pair<int, int>, Eigen::Index> seen;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::pair edge{mesh.triangles(k, t), mesh.triangles((k + 1) % 3, t)};
      const auto [place, is_new] = seen.try_emplace(edge, t);
      if (is_new) continue;
      items[static_cast<std::size_t>(t)].fail(
          fmt::format("runs from point {} to point {} as triangle {} does, expected neighbors to "
                      "run along their edge in opposite directions",
                      edge.first, edge.second, place->second));
    }
  }
}

MeshShape read_mesh(const TomlTable& table) {
  MeshShape mesh;
  mesh.points = read_points(table, 3, kMaxMeshPoints);
  const std::string expected = "an array of triangles such as [[0, 1, 2], [2, 1, 3]]";
  const TomlValue value = table.require("triangles", expected);
  const std::vector<TomlValue> items = value.items(expected);
  check_count(value, items.size(), 1, kMaxTriangles, "triangles");
  mesh.triangles.resize(3, static_cast<Eigen::Index>(items.size()));
  const int last = static_cast<int>(mesh.points.cols()) - 1;
  for (std::size_t t = 0; t < items.size(); ++t) {
    const std::vector<TomlValue> corners = items[t].items("three numbers of points", 3);
    Vector3<int> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[static_cast<int>(k)] = corners[k].integer(0, last);
    const Vector3<double> a = mesh.points.col(corner[0]);
    const Vector3<double> side = mesh.points.col(corner[1]) - a;
    if (side.cross(Vector3<double>(mesh.points.col(corner[2]) - a)).isZero(0)) {
      items[t].fail("has no area, expected three points that are not in line");
    }
    mesh.triangles.col(static_cast<Eigen::Index>(t)) = corner;
  }
  check_edges(mesh, items);
  return mesh;
}

HeightFieldShape read_height_field(const TomlTable& table) {
  HeightFieldShape field;
  const std::string sides = "two edge lengths such as [\"4 m\", \"4 m\"]";
  const std::vector<TomlValue> size = table.require("size", sides).items(sides, 2);
  field.size = {size[0].positive("m"), size[1].positive("m")};
  const double unit = read_unit(table);
  const std::string expected = "rows of heights such as [[0, 0], [0, 1]]";
  const TomlValue value = table.require("heights", expected);
  const std::vector<TomlValue> rows = value.items(expected);
  check_count(value, rows.size(), 2, kMaxSamples, "rows");
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const std::vector<TomlValue> row = rows[j].items("a row of heights such as [0, 1]");
    if (j == 0) {
      check_count(rows[j], row.size(), 2, kMaxSamples, "heights");
      field.heights.resize(static_cast<Eigen::Index>(rows.size()),
                           static_cast<Eigen::Index>(row.size()));
    } else if (static_cast<Eigen::Index>(row.size()) != field.heights.cols()) {
      rows[j].fail(fmt::format("has {} heights, expected {} as in the first row", row.size(),
                               field.heights.cols()));
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
      field.heights(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) =
          unit * row[i].quantity("1");
    }
  }
  return field;
}

std::vector<std::string_view> keys_of(std::string_view word) {
  if (word == "sphere") return {"radius"};
  if (word == "box") return {"size"};
  if (word == "capsule" || word == "cylinder" || word == "cone") return {"radius", "height"};
  if (word == "convex_hull") return {"unit", "points"};
  if (word == "mesh") return {"unit", "points", "triangles"};
  if (word == "compound") return {"part"};
  if (word == "height_field") return {"unit", "size", "heights"};
  return {};
}

ConvexShape read_convex(const TomlTable& table, std::string_view word) {
  if (word == "sphere") return SphereShape{read_length(table, "radius")};
  if (word == "box") return BoxShape{read_half_extents(table)};
  if (word == "convex_hull") return read_hull(table);
  const double radius = read_length(table, "radius");
  const double height = read_length(table, "height");
  if (word == "capsule") return CapsuleShape{radius, height};
  if (word == "cylinder") return CylinderShape{radius, height};
  return ConeShape{radius, height};
}

CompoundPart read_part(const TomlTable& table) {
  const TomlValue shape =
      table.require("shape", fmt::format("one of {}", fmt::join(kConvexWords, ", ")));
  const std::string_view word = kConvexWords[shape.choice(kConvexWords, "shape of a part")];
  std::vector<std::string_view> keys = keys_of(word);
  keys.insert(keys.end(), {"shape", "position", "orientation"});
  table.allow(keys);
  CompoundPart part{read_convex(table, word)};
  if (const auto value = table.find("position")) part.position = value->vector("m");
  if (const auto value = table.find("orientation")) part.orientation = read_orientation(*value);
  return part;
}

CompoundShape read_compound(const TomlTable& table) {
  const std::string expected =
      "an array of parts such as [{ shape = \"sphere\", radius = \"1 m\" }]";
  const TomlValue value = table.require("part", expected);
  const std::vector<TomlValue> items = value.items(expected);
  check_count(value, items.size(), 1, kMaxParts, "parts");
  CompoundShape compound;
  for (const TomlValue& item : items) {
    compound.parts.push_back(read_part(item.table("a table such as { shape = \"sphere\" }")));
  }
  return compound;
}

}  // namespace

Shape read_shape(const TomlTable& table, std::vector<std::string_view> other_keys) {
  const TomlValue shape =
      table.require("shape", fmt::format("one of {}", fmt::join(kShapeWords, ", ")));
  const std::string_view word = kShapeWords[shape.choice(kShapeWords, "shape")];
  const std::vector<std::string_view> keys = keys_of(word);
  other_keys.insert(other_keys.end(), keys.begin(), keys.end());
  table.allow(other_keys);
  if (word == "plane") return PlaneShape{};
  if (word == "mesh") return read_mesh(table);
  if (word == "compound") return read_compound(table);
  if (word == "height_field") return read_height_field(table);
  return as_shape(read_convex(table, word));
}

}  // namespace weft::scenes
