// Tested by tests/scenes/format/scene_file_test.cpp.

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <weft/custom_forces/registry.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 5> kTearKeys = {"strain", "variation", "max_splits", "weak",
                                                       "cut"};
constexpr std::array<std::string_view, 2> kWeakKeys = {"region", "strain"};
constexpr std::array<std::string_view, 3> kCutKeys = {"from", "to", "depth"};

// Each is a pass over the cloth; more are a mistake.
constexpr std::size_t kMaxCuts = 100;
constexpr int kMaxSplits = 10'000;

WeakRegion read_weak(const TomlValue& entry, const Cloth& cloth) {
  const TomlTable table = entry.table("a table such as { region = \"seam\", strain = 0.2 }");
  table.allow(kWeakKeys);
  std::vector<std::string_view> names;
  for (const Region& region : cloth.regions) names.push_back(region.name);
  const TomlValue region = table.require("region", "the name of a region of this cloth");
  if (names.empty()) region.fail("the cloth has no region, expected one of this name");
  const std::string name(names[region.choice(names, "region of this cloth")]);
  return {name, table.require("strain", "a number such as 0.2").positive("1")};
}

Blade read_cut(const TomlValue& entry) {
  const TomlTable table =
      entry.table("a table such as { from = [...], to = [...], depth = [...] }");
  table.allow(kCutKeys);
  const std::string place = "a place such as [\"0 m\", \"1 m\", \"0 m\"]";
  Blade blade;
  blade.from = table.require("from", place).vector("m");
  blade.to = table.require("to", place).vector("m");
  const TomlValue depth =
      table.require("depth", "a vector through the cloth such as [\"0 m\", \"0 m\", \"1 cm\"]");
  blade.depth = depth.vector("m");
  const double area = (blade.to - blade.from).cross(blade.depth).norm();
  if (!(area > 0)) depth.fail("spans no area with from and to, expected another direction");
  return blade;
}

}  // namespace

ClothTear read_tear(const TomlValue& value, const Cloth& cloth) {
  const TomlTable table = value.table("a table such as { strain = 0.5 }");
  table.allow(kTearKeys);
  for (const forces::LawSpecification& law : cloth.laws) {
    if (forces::find_law(law.law)->traits.needs_closed_surface) {
      value.fail(fmt::format("opens the surface that the law {} needs closed, expected no such law",
                             law.law));
    }
  }
  ClothTear tear;
  tear.rule.strain = table.require("strain", "a number such as 0.5").positive("1");
  if (const auto variation = table.find("variation")) {
    tear.rule.variation = variation->non_negative("1");
    if (tear.rule.variation >= 1) variation->fail("expected a number below 1");
  }
  if (const auto splits = table.find("max_splits")) {
    tear.rule.max_splits = splits->integer(1, kMaxSplits);
  }
  if (const auto weak = table.find("weak")) {
    for (const TomlValue& entry :
         weak->items("an array such as [{ region = ..., strain = 0.2 }]")) {
      tear.rule.weak.push_back(read_weak(entry, cloth));
    }
  }
  if (const auto cuts = table.find("cut")) {
    const auto entries = cuts->items("an array such as [{ from = ..., to = ..., depth = ... }]");
    if (entries.size() > kMaxCuts) cuts->fail(fmt::format("expected at most {} cuts", kMaxCuts));
    for (const TomlValue& entry : entries) tear.cuts.push_back(read_cut(entry));
  }
  return tear;
}

}  // namespace weft::scenes
