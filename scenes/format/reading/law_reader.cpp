// Tested by tests/scenes/format/scene_file_test.cpp.

#include <algorithm>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>

namespace weft::scenes {
namespace {

const forces::LawInfo& find_info(const TomlTable& table) {
  std::vector<std::string_view> ids;
  for (const forces::LawInfo* info : forces::all_laws()) ids.push_back(info->id);
  const TomlValue law = table.require("law", fmt::format("one of {}", fmt::join(ids, ", ")));
  return *forces::all_laws()[law.choice(ids, "law")];
}

/// Names of the sets that a law of this kind may name: those of the source, and the cloth's own
/// connections and regions.
std::vector<std::string> set_names(forces::ElementKind elements, const Cloth& cloth) {
  std::vector<std::string> names = source_sets(cloth.source, elements);
  if (elements == forces::ElementKind::kEdges) {
    for (const Region& region : cloth.regions) {
      if (region.has_springs) names.push_back(region.name);
    }
  } else if (elements == forces::ElementKind::kNodeSets) {
    for (const Region& region : cloth.regions) names.push_back(region.name);
  } else if (elements == forces::ElementKind::kConnections) {
    for (const Connection& connection : cloth.connections) names.push_back(connection.name);
  }
  return names;
}

/// Refuses a law that can do nothing for a body without triangles, or for one that is open.
void check_surface(const forces::LawInfo& info, const TomlTable& table, const Cloth& cloth) {
  const bool is_rope = std::holds_alternative<Rope>(cloth.source);
  if (info.traits.needs_closed_surface &&
      (is_rope || std::holds_alternative<ClothGrid>(cloth.source))) {
    table.require("law", "a law")
        .fail(fmt::format("needs a closed surface, expected another law for {}, which is open",
                          source_name(cloth.source)));
  }
  const bool needs_triangles = info.traits.elements == forces::ElementKind::kFaces ||
                               info.traits.elements == forces::ElementKind::kHinges;
  if (needs_triangles && is_rope) {
    table.require("law", "a law")
        .fail("acts on triangles, expected another law for a rope, which has none");
  }
}

std::vector<std::string> read_sets(const TomlTable& table, std::string_view key,
                                   forces::ElementKind elements, const Cloth& cloth) {
  const std::vector<std::string> all = set_names(elements, cloth);
  const std::optional<TomlValue> value = table.find(key);
  if (!value) {
    // The springs of a region are some of the source's once more: only for laws that name them.
    if (elements == forces::ElementKind::kEdges) return source_sets(cloth.source, elements);
    if (!all.empty()) return all;
    table.fail(fmt::format("{} is empty, expected a cloth with at least one", key));
  }
  const std::string what =
      elements == forces::ElementKind::kEdges ? "edge set of this cloth" : "set of this cloth";
  const std::vector<std::string_view> words(all.begin(), all.end());
  std::vector<std::string> names;
  for (const TomlValue& entry : value->items("an array such as [\"stretch\"]")) {
    const std::string& name = all[entry.choice(words, what)];
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      entry.fail("is there twice, expected each set once");
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

forces::LawSpecification read_law(const TomlTable& table, const Cloth& cloth, const World& world) {
  const forces::LawInfo& info = find_info(table);
  std::vector<std::string_view> keys = {"law"};
  check_surface(info, table, cloth);
  const std::string_view sets_key = set_key(info.traits.elements);
  if (!sets_key.empty()) keys.push_back(sets_key);
  for (const forces::ParameterInfo& parameter : info.parameters) keys.push_back(parameter.name);
  table.allow(keys);

  forces::LawSpecification law;
  law.law = info.id;
  if (!sets_key.empty()) law.sets = read_sets(table, sets_key, info.traits.elements, cloth);
  for (const forces::ParameterInfo& parameter : info.parameters) {
    if (const std::optional<TomlValue> value = table.find(parameter.name)) {
      law.parameters.emplace(parameter.name, read_parameter(*value, parameter));
    } else if (info.traits.role == forces::LawRole::kGravity && parameter.name == "acceleration") {
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
