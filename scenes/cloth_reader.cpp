#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/custom_forces/core/error.hpp>
#include <weft/scenes/appearance_reader.hpp>
#include <weft/scenes/quantity.hpp>
#include <weft/scenes/scene_reader.hpp>
#include <weft/scenes/scene_words.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 15> kClothKeys = {
    "name", "grid",          "center",       "u_axis",           "v_axis",
    "mass", "areal_density", "mass_lumping", "collision_margin", "friction",
    "law",  "velocity",      "pin",          "connection",       "region"};
constexpr std::array<std::string_view, 3> kGridKeys = {"nodes", "size", "stencil"};
constexpr std::array<std::string_view, 3> kPinKeys = {"corner", "edge", "box"};
constexpr std::array<std::string_view, 5> kMovingPinKeys = {"corner", "edge", "box", "velocity",
                                                            "path"};
constexpr std::array<std::string_view, 2> kRegionKeys = {"name", "nodes"};
constexpr std::array<std::string_view, 2> kBoxPinKeys = {"min", "max"};
constexpr std::array<std::string_view, 3> kConnectionKeys = {"name", "node", "to"};

// Each box pin is tried on the mesh; more of them than this would make reading slow.
constexpr std::size_t kMaxPins = 100;

void read_grid(const TomlTable& table, ClothGrid& grid) {
  table.allow(kGridKeys);
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
    grid.stencil = static_cast<GridStencil>(value->choice(kStencilWords, "stencil"));
  }
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

double read_mass(const TomlTable& table, const ClothGrid& grid) {
  const std::optional<TomlValue> mass = table.find("mass");
  const std::optional<TomlValue> density = table.find("areal_density");
  if (mass && density) density->fail("mass is given too, expected exactly one of the two");
  if (mass) return mass->positive("kg");
  if (!density)
    table.fail("missing key 'mass' or 'areal_density', expected exactly one of the two");
  const double total = density->positive("kg/m^2") * grid.size[0] * grid.size[1];
  if (!(total > 0) || !std::isfinite(total)) {
    density->fail(
        fmt::format("makes a mass of {}, expected > 0 and finite", format_quantity(total, "kg")));
  }
  return total;
}

BoxPin read_box_pin(const TomlTable& table) {
  table.allow(kBoxPinKeys);
  const std::string expected = "a corner such as [\"0 m\", \"0 m\", \"0 m\"]";
  const TomlValue maximum = table.require("max", expected);
  const BoxPin pin{table.require("min", expected).vector("m"), maximum.vector("m")};
  if ((pin.minimum.array() > pin.maximum.array()).any()) {
    maximum.fail("is below min, expected max >= min on every axis");
  }
  return pin;
}

Pin read_pin(const TomlTable& table) {
  const auto corner = table.find("corner");
  const auto edge = table.find("edge");
  const auto box = table.find("box");
  if (int{corner.has_value()} + int{edge.has_value()} + int{box.has_value()} != 1) {
    table.fail("expected exactly one of corner, edge, box");
  }
  if (corner) {
    const auto index = static_cast<int>(corner->choice(kCornerWords, "corner"));
    return CornerPin{.u = -(index % 2), .v = -(index / 2)};
  }
  if (edge) {
    const auto index = static_cast<int>(edge->choice(kEdgeWords, "edge"));
    return EdgePin{.axis = index / 2, .side = -(index % 2)};
  }
  return read_box_pin(box->table("a table such as { min = [...], max = [...] }"));
}

std::vector<Connection> read_connections(const TomlValue& value, const Cloth& cloth) {
  const std::string expected = "a table such as { name = \"ties\", node = [25, 25] }";
  std::vector<Connection> connections;
  for (const TomlValue& entry : value.items("an array such as [{ name = ..., node = [25, 25] }]")) {
    const TomlTable table = entry.table(expected);
    table.allow(kConnectionKeys);
    Connection connection;
    connection.name = table.require("name", "a name such as \"ties\"").identifier();
    for (const Connection& other : connections) {
      if (other.name == connection.name) {
        entry.fail("has the name of another connection, expected a new one");
      }
    }
    const std::string node = "column and row such as [25, 25]";
    const std::vector<TomlValue> indices = table.require("node", node).items(node, 2);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int count = cloth.grid.nodes[axis];
      connection.node[axis] = indices[axis].integer(-count, count - 1);
    }
    if (const auto to = table.find("to")) connection.to = read_pins(*to, cloth);
    connections.push_back(std::move(connection));
  }
  return connections;
}

std::vector<Region> read_regions(const TomlValue& value, const Cloth& cloth) {
  const std::string expected = "a table such as { name = \"hand\", nodes = [{ edge = \"-u\" }] }";
  std::vector<Region> regions;
  for (const TomlValue& entry : value.items("an array such as [{ name = ..., nodes = [...] }]")) {
    const TomlTable table = entry.table(expected);
    table.allow(kRegionKeys);
    Region region;
    region.name = table.require("name", "a name such as \"hand\"").identifier();
    for (const Region& other : regions) {
      if (other.name == region.name) {
        entry.fail("has the name of another region, expected a new one");
      }
    }
    const TomlValue nodes = table.require("nodes", "an array such as [{ edge = \"-u\" }]");
    region.nodes = read_pins(nodes, cloth);
    if (region.nodes.empty()) nodes.fail("is empty, expected at least one corner, edge or box");
    regions.push_back(std::move(region));
  }
  return regions;
}

void read_laws(const TomlTable& table, const World& world, Cloth& cloth) {
  for (const TomlTable& law : table.tables("law")) {
    cloth.laws.push_back(read_law(law, cloth, world));
  }
}

constexpr const char* kExpectedPin = "a table such as { corner = \"-u-v\" }";

std::vector<TomlValue> pin_entries(const TomlValue& value) {
  std::vector<TomlValue> entries = value.items("an array such as [{ corner = \"-u-v\" }]");
  if (entries.size() > kMaxPins) value.fail(fmt::format("expected at most {} pins", kMaxPins));
  return entries;
}

void check_holds_nodes(const TomlValue& entry, const Pin& pin, const Cloth& cloth) {
  if (!std::holds_alternative<BoxPin>(pin)) return;
  Cloth probe;
  probe.name = cloth.name;
  probe.grid = cloth.grid;
  probe.grid.stencil = GridStencil::k8Neighbour;  // the fewest springs: only positions matter
  probe.pins = {pin};
  try {
    (void)make_mesh(probe);
  } catch (const InvalidArgument&) {
    entry.fail("holds no node, expected a box with at least one node of the cloth");
  }
}

/// The pins of a cloth, which may move.
void read_cloth_pins(const TomlValue& value, Cloth& cloth) {
  for (const TomlValue& entry : pin_entries(value)) {
    const TomlTable table = entry.table(kExpectedPin);
    table.allow(kMovingPinKeys);
    const Pin pin = read_pin(table);
    check_holds_nodes(entry, pin, cloth);
    const auto velocity = table.find("velocity");
    const auto path = table.find("path");
    if (velocity && path) velocity->fail("path is given too, expected at most one of the two");
    if (velocity) {
      cloth.moving_pins.push_back({pin, velocity->vector("m/s")});
    } else if (path) {
      cloth.moving_pins.push_back({.nodes = pin, .path = read_path(*path)});
    } else {
      cloth.pins.push_back(pin);
    }
  }
}

}  // namespace

std::vector<Pin> read_pins(const TomlValue& value, const Cloth& cloth) {
  std::vector<Pin> pins;
  for (const TomlValue& entry : pin_entries(value)) {
    const TomlTable table = entry.table(kExpectedPin);
    table.allow(kPinKeys);
    pins.push_back(read_pin(table));
    check_holds_nodes(entry, pins.back(), cloth);
  }
  return pins;
}

Cloth read_cloth(const TomlTable& table, const World& world) {
  std::vector<std::string_view> keys(kClothKeys.begin(), kClothKeys.end());
  keys.insert(keys.end(), kClothAppearanceKeys.begin(), kClothAppearanceKeys.end());
  table.allow(keys);
  Cloth cloth;
  cloth.name = table.require("name", "a name such as \"cloth\"").identifier();
  const std::string grid = "a table such as { nodes = [50, 50], size = [\"1 m\", \"1 m\"] }";
  read_grid(table.require("grid", grid).table(grid), cloth.grid);
  read_frame(table, cloth.grid);
  cloth.grid.total_mass = read_mass(table, cloth.grid);
  if (const auto value = table.find("mass_lumping")) {
    cloth.grid.lumping = static_cast<MassLumping>(value->choice(kLumpingWords, "mass lumping"));
  }
  if (const auto value = table.find("velocity")) cloth.velocity = value->vector("m/s");
  if (const auto value = table.find("collision_margin")) {
    cloth.collision_margin = value->non_negative("m");
  }
  if (const auto value = table.find("friction")) cloth.friction = value->non_negative("1");
  if (const auto value = table.find("pin")) read_cloth_pins(*value, cloth);
  if (const auto value = table.find("connection")) {
    cloth.connections = read_connections(*value, cloth);
  }
  if (const auto value = table.find("region")) cloth.regions = read_regions(*value, cloth);
  read_laws(table, world, cloth);
  cloth.appearance = read_appearance(table);
  return cloth;
}

}  // namespace weft::scenes
