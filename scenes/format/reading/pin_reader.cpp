// Tested by tests/scenes/format/scene_file_test.cpp, tests/scenes/body_sources_test.cpp.

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>
#include <weft/scenes/format/scene_words.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 12> kMovingPinKeys = {
    "corner",       "edge",    "box",   "sphere",   "nodes", "part",
    "vertex_group", "texture", "above", "velocity", "path",  "to"};
constexpr Keys kMotionKeys = Keys(kMovingPinKeys).last(3);
constexpr Keys kPinKinds = Keys(kMovingPinKeys).first(8);
constexpr Keys kPinKeys = Keys(kMovingPinKeys).first(9);
constexpr std::array<std::string_view, 2> kBoxKeys = {"min", "max"};
constexpr std::array<std::string_view, 2> kSphereKeys = {"center", "radius"};

// Each pin is tried on the mesh; more of them than this would make reading slow.
constexpr std::size_t kMaxPins = 100;

constexpr const char* kExpectedPin = "a table such as { corner = \"-u-v\" }";
const std::string kExpectedPoint = "a point such as [\"0 m\", \"0 m\", \"0 m\"]";

BoxPin read_box(const TomlTable& table) {
  table.allow(kBoxKeys);
  const TomlValue maximum = table.require("max", kExpectedPoint);
  const BoxPin pin{table.require("min", kExpectedPoint).vector("m"), maximum.vector("m")};
  if ((pin.minimum.array() > pin.maximum.array()).any()) {
    maximum.fail("is below min, expected max >= min on every axis");
  }
  return pin;
}

SpherePin read_sphere(const TomlTable& table) {
  table.allow(kSphereKeys);
  return {table.require("center", kExpectedPoint).vector("m"),
          table.require("radius", expected_quantity("m")).positive("m")};
}

/// One entry: a number, or "first-last".
void read_nodes(const TomlValue& entry, const Cloth& cloth, std::vector<int>& nodes) {
  const int last_node = num_nodes(cloth.source) - 1;
  if (!entry.is_text()) {
    nodes.push_back(entry.integer(0, last_node));
    return;
  }
  const std::string text = entry.text();
  const std::size_t dash = text.find('-');
  const auto number = [&](const std::string& digits) {
    constexpr std::size_t kMaxDigits = 9;  // fits an int
    const bool is_number =
        !digits.empty() && digits.size() <= kMaxDigits &&
        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!is_number) entry.fail("expected a node number or a range such as \"10-20\"");
    return std::stoi(digits);
  };
  const int first = number(text.substr(0, dash));
  const int last = dash == std::string::npos ? first : number(text.substr(dash + 1));
  if (first > last || last > last_node) {
    entry.fail(fmt::format("expected a range within 0 to {}, the smaller number first", last_node));
  }
  for (int node = first; node <= last; ++node) nodes.push_back(node);
}

NodePin read_node_list(const TomlValue& value, const Cloth& cloth) {
  NodePin pin;
  for (const TomlValue& entry : value.items("an array such as [0, 5, \"10-20\"]")) {
    // Ranges may overlap: a few of them should not make an endless list.
    if (pin.nodes.size() > static_cast<std::size_t>(2 * kMaxNodes))
      value.fail("has too many nodes");
    read_nodes(entry, cloth, pin.nodes);
  }
  if (pin.nodes.empty()) value.fail("is empty, expected at least one node");
  std::sort(pin.nodes.begin(), pin.nodes.end());
  pin.nodes.erase(std::unique(pin.nodes.begin(), pin.nodes.end()), pin.nodes.end());
  return pin;
}

/// The nodes of a part of a mesh file, or of one of its vertex groups.
NodePin read_group(const TomlTable& table, const TomlValue& value, bool is_part,
                   const Cloth& cloth) {
  const auto* body = std::get_if<MeshBody>(&cloth.source);
  if (body == nullptr) {
    value.fail(
        fmt::format("{} has no parts and groups, expected a mesh", source_name(cloth.source)));
  }
  const auto limit = table.find("above");
  const double above = limit ? limit->quantity("1") : 0.5;
  std::vector<std::string_view> names;
  for (const import::NodeGroup& group : body->shape->groups) {
    if (group.is_part == is_part) names.push_back(group.name);
  }
  const std::string_view name = names[value.choice(names, is_part ? "part" : "vertex group")];
  NodePin pin;
  for (const import::NodeGroup& group : body->shape->groups) {
    if (group.is_part != is_part || group.name != name) continue;
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      if (is_part || group.weights[i] > above) pin.nodes.push_back(group.nodes[i]);
    }
  }
  if (pin.nodes.empty()) value.fail(fmt::format("has no weight above {}", above));
  return pin;
}

void require_grid(const TomlValue& value, const Cloth& cloth) {
  if (std::holds_alternative<ClothGrid>(cloth.source)) return;
  value.fail(fmt::format("{} has no corners and edges, expected one of box, sphere, nodes",
                         source_name(cloth.source)));
}

Pin read_pin(const TomlTable& table, const Cloth& cloth) {
  std::vector<std::string_view> given;
  for (const std::string_view key : kPinKinds) {
    if (table.has(key)) given.push_back(key);
  }
  if (given.size() != 1) {
    table.fail(fmt::format("expected exactly one of {}", fmt::join(kPinKinds, ", ")));
  }
  const TomlValue value = table.require(given[0], "");
  if (given[0] == "box")
    return read_box(value.table("a table such as { min = [...], max = [...] }"));
  if (given[0] == "sphere") {
    return read_sphere(value.table("a table such as { center = [...], radius = \"1 cm\" }"));
  }
  if (given[0] == "nodes") return read_node_list(value, cloth);
  if (given[0] == "texture") return read_mask(table, value, cloth);
  if (table.has("above") && given[0] != "vertex_group") {
    table.fail("above goes with vertex_group and texture only");
  }
  if (given[0] == "part") return read_group(table, value, true, cloth);
  if (given[0] == "vertex_group") return read_group(table, value, false, cloth);
  require_grid(value, cloth);
  if (given[0] == "corner") {
    const auto index = static_cast<int>(value.choice(kCornerWords, "corner"));
    return CornerPin{.u = -(index % 2), .v = -(index / 2)};
  }
  const auto index = static_cast<int>(value.choice(kEdgeWords, "edge"));
  return EdgePin{.axis = index / 2, .side = -(index % 2)};
}

std::vector<TomlValue> pin_entries(const TomlValue& value) {
  std::vector<TomlValue> entries = value.items("an array such as [{ corner = \"-u-v\" }]");
  if (entries.size() > kMaxPins) value.fail(fmt::format("expected at most {} pins", kMaxPins));
  return entries;
}

void check_holds_nodes(const TomlValue& entry, const Pin& pin, const Cloth& cloth) {
  const bool is_box = std::holds_alternative<BoxPin>(pin);
  if (!is_box && !std::holds_alternative<SpherePin>(pin)) return;
  Cloth probe;
  probe.name = cloth.name;
  probe.source = cloth.source;
  probe.bulge = cloth.bulge;
  // The fewest springs: only positions matter.
  if (auto* grid = std::get_if<ClothGrid>(&probe.source)) grid->stencil = GridStencil::k8Neighbour;
  probe.pins = {pin};
  try {
    (void)make_mesh(probe);
  } catch (const InvalidArgument&) {
    entry.fail(fmt::format("holds no node, expected a {} with at least one node of the cloth",
                           is_box ? "box" : "sphere"));
  }
}

}  // namespace

std::vector<Pin> read_pins(const TomlValue& value, const Cloth& cloth) {
  std::vector<Pin> pins;
  for (const TomlValue& entry : pin_entries(value)) {
    const TomlTable table = entry.table(kExpectedPin);
    table.allow(kPinKeys);
    pins.push_back(read_pin(table, cloth));
    check_holds_nodes(entry, pins.back(), cloth);
  }
  return pins;
}

void read_cloth_pins(const TomlValue& value, Cloth& cloth) {
  for (const TomlValue& entry : pin_entries(value)) {
    const TomlTable table = entry.table(kExpectedPin);
    table.allow(kMovingPinKeys);
    const Pin pin = read_pin(table, cloth);
    check_holds_nodes(entry, pin, cloth);
    std::vector<std::string_view> given;
    for (const std::string_view key : kMotionKeys) {
      if (table.has(key)) given.push_back(key);
    }
    if (given.size() > 1) {
      table.require(given[0], "")
          .fail(fmt::format("{} is given too, expected at most one of {}", given[1],
                            fmt::join(kMotionKeys, ", ")));
    }
    if (const auto velocity = table.find("velocity")) {
      cloth.moving_pins.push_back({pin, velocity->vector("m/s")});
    } else if (const auto path = table.find("path")) {
      cloth.moving_pins.push_back({.nodes = pin, .path = read_path(*path)});
    } else if (const auto to = table.find("to")) {
      cloth.moving_pins.push_back({.nodes = pin, .to = to->identifier()});
    } else {
      cloth.pins.push_back(pin);
    }
  }
}

void check_carriers(const TomlTable& cloth, const Scene& scene) {
  const auto pins = cloth.find("pin");
  if (!pins) return;
  for (const TomlValue& entry : pin_entries(*pins)) {
    const auto to = entry.table(kExpectedPin).find("to");
    if (!to) continue;
    const std::string name = to->identifier();
    const auto found = std::find_if(scene.colliders.begin(), scene.colliders.end(),
                                    [&](const Collider& c) { return c.name == name; });
    if (found == scene.colliders.end()) to->fail("expected the name of a collider of this scene");
    if (found->mass) {
      to->fail(
          "has a mass, expected a collider without one; the controller \"attach\" ties a cloth to "
          "a body that moves freely");
    }
  }
}

}  // namespace weft::scenes
