#include <algorithm>

#include <fmt/format.h>

#include <weft/custom_forces/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/scenes/quantity.hpp>
#include <weft/scenes/scene_reader.hpp>

namespace weft::scenes {
namespace {

const forces::LawInfo& find_info(const TomlTable& table) {
  std::vector<std::string_view> ids;
  for (const forces::LawInfo* info : forces::all_laws()) ids.push_back(info->id);
  const TomlValue law = table.require("law", fmt::format("one of {}", fmt::join(ids, ", ")));
  return *forces::all_laws()[law.choice(ids, "law")];
}

/// Names of the edge sets that a grid with this stencil has, asked of a small one.
std::vector<std::string> edge_set_names(const ClothGrid& grid) {
  ClothGrid probe;
  probe.stencil = grid.stencil;
  std::vector<std::string> names;
  for (const EdgeSet& set : make_cloth_grid(probe).edge_sets) names.push_back(set.name);
  return names;
}

std::vector<std::string> read_edge_sets(const TomlTable& table, const ClothGrid& grid) {
  const std::vector<std::string> all = edge_set_names(grid);
  const std::optional<TomlValue> value = table.find("edge_sets");
  if (!value) return all;
  const std::vector<std::string_view> words(all.begin(), all.end());
  std::vector<std::string> names;
  for (const TomlValue& entry : value->items("an array such as [\"stretch\"]")) {
    const std::string& name = all[entry.choice(words, "edge set of this stencil")];
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      entry.fail("is there twice, expected each edge set once");
    }
    names.push_back(name);
  }
  if (names.empty()) value->fail(fmt::format("expected at least one of {}", fmt::join(all, ", ")));
  return names;
}

std::vector<double> read_parameter(const TomlValue& value, const forces::ParameterInfo& parameter) {
  if (parameter.size == 3) {
    const Vector3<double> vector = value.vector(parameter.unit);
    return {vector.x(), vector.y(), vector.z()};
  }
  const double number = value.quantity(parameter.unit);
  if (number < parameter.minimum) {
    value.fail(fmt::format("expected >= {} [{}]", parameter.minimum, parameter.unit));
  }
  if (number > parameter.maximum) {
    value.fail(fmt::format("expected <= {} [{}]", parameter.maximum, parameter.unit));
  }
  return {number};
}

std::string expected_parameter(const forces::ParameterInfo& parameter) {
  if (parameter.size == 3) return fmt::format("three values in {}", parameter.unit);
  return parameter.unit == "1" ? "a number without unit" : expected_quantity(parameter.unit);
}

}  // namespace

forces::LawSpecification read_law(const TomlTable& table, const ClothGrid& grid,
                                  const World& world) {
  const forces::LawInfo& info = find_info(table);
  std::vector<std::string_view> keys = {"law"};
  if (info.traits.uses_edges) keys.push_back("edge_sets");
  for (const forces::ParameterInfo& parameter : info.parameters) keys.push_back(parameter.name);
  table.allow(keys);

  forces::LawSpecification law;
  law.law = info.id;
  if (info.traits.uses_edges) law.edge_sets = read_edge_sets(table, grid);
  for (const forces::ParameterInfo& parameter : info.parameters) {
    if (const std::optional<TomlValue> value = table.find(parameter.name)) {
      law.parameters.emplace(parameter.name, read_parameter(*value, parameter));
    } else if (info.id == "gravity" && parameter.name == "acceleration") {
      law.parameters.emplace(
          parameter.name,
          std::vector<double>{world.gravity.x(), world.gravity.y(), world.gravity.z()});
    } else if (parameter.required) {
      (void)table.require(parameter.name, expected_parameter(parameter));
    }
  }
  try {
    return forces::checked(law);
  } catch (const InvalidArgument& error) {
    table.fail(error.what());
  }
}

}  // namespace weft::scenes
