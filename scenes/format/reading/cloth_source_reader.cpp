// Tested by tests/scenes/format/scene_file_test.cpp, tests/scenes/body_sources_test.cpp.

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>
#include <weft/scenes/format/scene_words.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 4> kSourceWords = {"grid", "icosphere", "rope", "mesh"};
enum class SourceKind { kGrid, kIcosphere, kRope, kMesh };

constexpr std::array<std::string_view, 3> kGridKeys = {"nodes", "size", "stencil"};
constexpr std::array<std::string_view, 4> kIcosphereKeys = {"radius", "frequency", "center_node",
                                                            "center_mass_share"};
constexpr std::array<std::string_view, 3> kRopeKeys = {"nodes", "start", "end"};

constexpr int kMaxFrequency = 316;  // makes no more than kMaxNodes nodes
static_assert(10 * kMaxFrequency * kMaxFrequency + 3 <= kMaxNodes);

std::optional<SourceKind> find_kind(const TomlTable& table) {
  std::optional<SourceKind> found;
  for (std::size_t kind = 0; kind < kSourceWords.size(); ++kind) {
    const std::optional<TomlValue> value = table.find(kSourceWords[kind]);
    if (!value) continue;
    if (found) {
      value->fail(fmt::format("{} is given too, expected exactly one of {}",
                              kSourceWords[static_cast<std::size_t>(*found)],
                              fmt::join(kSourceWords, ", ")));
    }
    found = static_cast<SourceKind>(kind);
  }
  return found;
}

Vector3<double> read_axis(const TomlValue& value) {
  const Vector3<double> axis = value.vector("1");
  const double norm = axis.norm();
  if (!std::isfinite(norm) || norm == 0)
    value.fail("has no direction, expected a vector such as [1, 0, 0]");
  return axis;
}

void read_frame(const TomlTable& table, ClothGrid& grid) {
  if (const auto value = table.find("center")) grid.center = value->vector("m");
  const auto u_axis = table.find("u_axis");
  const auto v_axis = table.find("v_axis");
  if (u_axis) grid.u_axis = read_axis(*u_axis);
  if (v_axis) grid.v_axis = read_axis(*v_axis);
  if (!u_axis && !v_axis) return;
  ClothGrid probe;  // only the axes are in question
  probe.u_axis = grid.u_axis;
  probe.v_axis = grid.v_axis;
  try {
    (void)make_cloth_grid(probe);
  } catch (const InvalidArgument&) {
    (v_axis ? *v_axis : *u_axis)
        .fail("is not perpendicular to the other axis, expected u_axis . v_axis = 0");
  }
}

ClothGrid read_grid(const TomlTable& cloth) {
  const std::string expected = "a table such as { nodes = [50, 50], size = [\"1 m\", \"1 m\"] }";
  const TomlTable table = cloth.require("grid", expected).table(expected);
  table.allow(kGridKeys);
  ClothGrid grid;
  const TomlValue nodes = table.require("nodes", "two numbers such as [50, 50]");
  const std::vector<TomlValue> counts = nodes.items("two numbers such as [50, 50]", 2);
  const std::string lengths = "two lengths such as [\"1 m\", \"1 m\"]";
  const std::vector<TomlValue> sizes = table.require("size", lengths).items(lengths, 2);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    grid.nodes[axis] = counts[axis].integer(2, kMaxNodes / 2);
    grid.size[axis] = sizes[axis].positive("m");
  }
  if (static_cast<long long>(grid.nodes[0]) * grid.nodes[1] > kMaxNodes) {
    nodes.fail(fmt::format("makes {} x {} nodes, expected at most {} in all", grid.nodes[0],
                           grid.nodes[1], kMaxNodes));
  }
  if (const auto value = table.find("stencil")) {
    const std::size_t word = value->choice(kReadStencilWords, "stencil");
    grid.stencil = static_cast<GridStencil>(word % kStencilWords.size());
  }
  read_frame(cloth, grid);
  return grid;
}

}  // namespace

std::optional<double> read_center_node(const TomlTable& table) {
  const std::optional<TomlValue> share = table.find("center_mass_share");
  const std::optional<TomlValue> center = table.find("center_node");
  if (!center || !center->boolean()) {
    if (share) share->fail("there is no centre node, expected center_node = true as well");
    return std::nullopt;
  }
  if (!share) return kCenterMassShare;
  const double value = share->positive("1");
  if (value >= 1) share->fail("expected a number > 0 and < 1");
  return value;
}

namespace {

Icosphere read_icosphere(const TomlTable& cloth) {
  const std::string expected = "a table such as { radius = \"20 cm\", frequency = 4 }";
  const TomlTable table = cloth.require("icosphere", expected).table(expected);
  table.allow(kIcosphereKeys);
  Icosphere sphere;
  sphere.radius = table.require("radius", expected_quantity("m")).positive("m");
  sphere.frequency = table.require("frequency", "a number such as 4").integer(1, kMaxFrequency);
  sphere.center_mass_share = read_center_node(table);
  if (const auto value = cloth.find("center")) sphere.center = value->vector("m");
  if (const auto value = cloth.find("orientation")) {
    sphere.orientation = read_orientation(*value);
  }
  return sphere;
}

Rope read_rope(const TomlTable& cloth) {
  const std::string point = "a point such as [\"0 m\", \"1 m\", \"0 m\"]";
  const std::string expected = "a table such as { nodes = 20, start = [...], end = [...] }";
  const TomlTable table = cloth.require("rope", expected).table(expected);
  table.allow(kRopeKeys);
  Rope rope;
  rope.nodes = table.require("nodes", "a number such as 20").integer(2, kMaxNodes);
  rope.start = table.require("start", point).vector("m");
  const TomlValue end = table.require("end", point);
  rope.end = end.vector("m");
  const double length = (rope.end - rope.start).norm();
  if (!(length > 0) || !std::isfinite(length)) {
    end.fail("makes a rope without length, expected another point than start");
  }
  return rope;
}

ClothSource read_geometry(const TomlTable& table) {
  const std::optional<SourceKind> kind = find_kind(table);
  if (!kind) {
    table.fail(fmt::format("missing key 'grid', expected exactly one of {}",
                           fmt::join(kSourceWords, ", ")));
  }
  if (kind == SourceKind::kIcosphere) return read_icosphere(table);
  if (kind == SourceKind::kRope) return read_rope(table);
  if (kind == SourceKind::kMesh) return read_mesh_body(table);
  return read_grid(table);
}

/// What a mass per measure is multiplied with: area [m^2], of a rope length [m].
double measure(const ClothGrid& grid) {
  return grid.size[0] * grid.size[1];
}
double measure(const Icosphere& sphere) {
  return surface_area(sphere);
}
double measure(const SkinSource& skin) {
  return skin_area(skin);
}
double measure(const Rope& rope) {
  return (rope.end - rope.start).norm();
}

double measure(const MeshBody& body) {
  return surface_area(body.shape->surface);
}

double read_mass(const TomlTable& table, const ClothSource& source) {
  const bool is_rope = std::holds_alternative<Rope>(source);
  const std::string_view density_key = is_rope ? "linear_density" : "areal_density";
  const std::optional<TomlValue> mass = table.find("mass");
  const std::optional<TomlValue> density = table.find(density_key);
  if (mass && density) density->fail("mass is given too, expected exactly one of the two");
  if (mass) return mass->positive("kg");
  if (!density) {
    table.fail(
        fmt::format("missing key 'mass' or '{}', expected exactly one of the two", density_key));
  }
  const double total = density->positive(is_rope ? "kg/m" : "kg/m^2") *
                       std::visit([](const auto& s) { return measure(s); }, source);
  if (!(total > 0) || !std::isfinite(total)) {
    density->fail(
        fmt::format("makes a mass of {}, expected > 0 and finite", format_quantity(total, "kg")));
  }
  return total;
}

}  // namespace

std::vector<std::string_view> cloth_source_keys(const TomlTable& table) {
  const std::optional<SourceKind> kind = find_kind(table);
  std::vector<std::string_view> keys = {"mass", "mass_lumping"};
  const auto add = [&](std::initializer_list<std::string_view> more) {
    keys.insert(keys.end(), more);
  };
  // Without a source every key is allowed, so that a misspelt one is found.
  const auto may_be = [&](SourceKind wanted) { return !kind || *kind == wanted; };
  if (may_be(SourceKind::kGrid)) add({"grid", "areal_density", "center", "u_axis", "v_axis"});
  if (may_be(SourceKind::kIcosphere)) add({"icosphere", "areal_density", "center", "orientation"});
  if (may_be(SourceKind::kRope)) add({"rope", "linear_density"});
  if (may_be(SourceKind::kMesh)) add({"mesh", "areal_density", "position", "orientation"});
  return keys;
}

ClothSource read_cloth_source(const TomlTable& table) {
  ClothSource source = read_geometry(table);
  const double total_mass = read_mass(table, source);
  const std::optional<TomlValue> lumping = table.find("mass_lumping");
  std::visit(
      [&](auto& s) {
        s.total_mass = total_mass;
        if (lumping) {
          s.lumping = static_cast<MassLumping>(lumping->choice(kLumpingWords, "mass lumping"));
        }
      },
      source);
  return source;
}

}  // namespace weft::scenes
