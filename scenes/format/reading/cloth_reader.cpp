// Tested by tests/scenes/format/scene_file_test.cpp, tests/scenes/body_sources_test.cpp.

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/appearance_reader.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 14> kClothKeys = {"bulge",
                                                         "name",
                                                         "collision_margin",
                                                         "friction",
                                                         "law",
                                                         "velocity",
                                                         "pin",
                                                         "connection",
                                                         "region",
                                                         "self_collision",
                                                         "self_thickness",
                                                         "soft_collision",
                                                         "tear",
                                                         "drawn_mesh"};
constexpr std::array<std::string_view, 3> kRegionKeys = {"name", "nodes", "springs"};
constexpr std::array<std::string_view, 3> kConnectionKeys = {"name", "node", "to"};

/// Column and row of a grid, or the number of a node.
void read_connection_node(const TomlTable& table, const Cloth& cloth, Connection& connection) {
  const auto* grid = std::get_if<ClothGrid>(&cloth.source);
  const std::string expected =
      grid != nullptr ? "column and row such as [25, 25], or a node number" : "a node number";
  const TomlValue node = table.require("node", expected);
  if (node.is_integer() || grid == nullptr) {
    connection.node_number = node.integer(0, num_nodes(cloth.source) - 1);
    return;
  }
  const std::vector<TomlValue> indices = node.items(expected, 2);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int count = grid->nodes[axis];
    connection.node[axis] = indices[axis].integer(-count, count - 1);
  }
}

std::vector<Connection> read_connections(const TomlValue& value, const Cloth& cloth) {
  const std::string expected = "a table such as { name = \"ties\", node = [25, 25] }";
  std::vector<std::string> taken = source_sets(cloth.source, forces::ElementKind::kConnections);
  std::vector<Connection> connections;
  for (const TomlValue& entry : value.items("an array such as [{ name = ..., node = [25, 25] }]")) {
    const TomlTable table = entry.table(expected);
    table.allow(kConnectionKeys);
    Connection connection;
    connection.name = table.require("name", "a name such as \"ties\"").identifier();
    if (std::find(taken.begin(), taken.end(), connection.name) != taken.end()) {
      entry.fail("has the name of another connection, expected a new one");
    }
    taken.push_back(connection.name);
    read_connection_node(table, cloth, connection);
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
    if (region.nodes.empty()) {
      nodes.fail("is empty, expected at least one corner, edge, box, sphere or node list");
    }
    if (const auto springs = table.find("springs")) region.has_springs = springs->boolean();
    const std::vector<std::string> sets = source_sets(cloth.source, forces::ElementKind::kEdges);
    if (region.has_springs && std::find(sets.begin(), sets.end(), region.name) != sets.end()) {
      entry.fail("has springs and the name of an edge set, expected another name");
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

Bulge read_bulge(const TomlValue& value, const Cloth& cloth) {
  constexpr std::array<std::string_view, 2> kKeys = {"height", "radius"};
  if (!std::holds_alternative<ClothGrid>(cloth.source)) value.fail("expected a grid to raise");
  const TomlTable table = value.table("a table such as { height = \"20 cm\", radius = \"40 cm\" }");
  table.allow(kKeys);
  return {.height = table.require("height", expected_quantity("m")).quantity("m"),
          .radius = table.require("radius", expected_quantity("m")).positive("m")};
}

}  // namespace

// A grid takes every law that check_surface() lets pass; whether another mesh does, is tried.
void read_laws(const TomlTable& table, const World& world, Cloth& cloth) {
  const std::vector<TomlTable> entries = table.tables("law");
  std::optional<ClothMesh> mesh;
  if (!entries.empty() && !std::holds_alternative<ClothGrid>(cloth.source)) {
    mesh = make_mesh(cloth);
  }
  for (const TomlTable& entry : entries) {
    cloth.laws.push_back(read_law(entry, cloth, world));
    if (!mesh) continue;
    try {
      (void)forces::make_law<double>(cloth.laws.back(), *mesh);
    } catch (const InvalidArgument& error) {
      entry.fail(error.what());
    }
  }
}

namespace {

void read_cloth_contact(const TomlTable& table, Cloth& cloth) {
  if (const auto value = table.find("self_collision")) cloth.self_collision = value->boolean();
  if (const auto value = table.find("self_thickness")) {
    cloth.self_thickness = value->positive("m");
    if (!cloth.self_collision) value->fail("expected self_collision = true as well");
  }
  if (const auto value = table.find("soft_collision")) cloth.soft_collision = value->boolean();
  if ((cloth.self_collision && !cloth.self_thickness) || cloth.soft_collision) {
    if (cloth.collision_margin > 0) return;
    table.require("collision_margin", "").fail("expected > 0: layers of cloth keep twice of it");
  }
}

}  // namespace

Cloth read_cloth(const TomlTable& table, const World& world) {
  std::vector<std::string_view> keys = cloth_source_keys(table);
  keys.insert(keys.end(), kClothKeys.begin(), kClothKeys.end());
  keys.insert(keys.end(), kClothAppearanceKeys.begin(), kClothAppearanceKeys.end());
  table.allow(keys);
  Cloth cloth;
  cloth.name = table.require("name", "a name such as \"cloth\"").identifier();
  cloth.source = read_cloth_source(table);
  if (const auto value = table.find("bulge")) cloth.bulge = read_bulge(*value, cloth);
  if (const auto value = table.find("velocity")) cloth.velocity = value->vector("m/s");
  if (const auto value = table.find("collision_margin")) {
    cloth.collision_margin = value->non_negative("m");
  }
  if (const auto value = table.find("friction")) cloth.friction = value->non_negative("1");
  read_cloth_contact(table, cloth);
  if (const auto value = table.find("pin")) read_cloth_pins(*value, cloth);
  if (const auto value = table.find("connection")) {
    cloth.connections = read_connections(*value, cloth);
  }
  if (const auto value = table.find("region")) cloth.regions = read_regions(*value, cloth);
  read_laws(table, world, cloth);
  if (const auto value = table.find("tear")) cloth.tear = read_tear(*value, cloth);
  cloth.appearance = read_appearance(table);
  if (const auto value = table.find("drawn_mesh")) {
    cloth.drawn_mesh = read_drawn_mesh(*value, cloth);
    check_drawn_mesh(*value, cloth);
  }
  return cloth;
}

}  // namespace weft::scenes
