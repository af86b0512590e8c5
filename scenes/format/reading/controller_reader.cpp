// Tested by tests/scenes/format/scene_file_test.cpp.

#include <algorithm>
#include <array>

#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>
#include <weft/scenes/format/scene_words.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 10> kSeekKeys = {"kind",   "cloth",  "region", "target",
                                                        "front",  "speed",  "force",  "turn_rate",
                                                        "torque", "arrival"};
constexpr std::array<std::string_view, 6> kAttachKeys = {"kind", "cloth",     "region",
                                                         "to",   "stiffness", "damping"};
constexpr std::array<std::string_view, 5> kDetailKeys = {"kind", "cloth", "levels", "blend",
                                                         "follow"};
constexpr std::array<std::string_view, 2> kSwitchKeys = {"time", "level"};
constexpr std::array<std::string_view, 6> kRollKeys = {"kind",      "cloth",  "target",
                                                       "turn_rate", "torque", "arrival"};

const Cloth& read_cloth_name(const TomlTable& table, const Scene& scene) {
  const TomlValue value = table.require("cloth", "the name of a cloth");
  const std::string name = value.identifier();
  const auto found = std::find_if(scene.cloths.begin(), scene.cloths.end(),
                                  [&](const Cloth& cloth) { return cloth.name == name; });
  if (found == scene.cloths.end()) value.fail("expected the name of a cloth of this scene");
  return *found;
}

/// A place that stands still, or one that moves.
Path read_target(const TomlTable& table) {
  const TomlValue value = table.require("target", "a path, or a place that stays where it is");
  if (value.is_table()) return read_path(value);
  const Vector3<double> place = value.vector("m");
  Path path;
  path.times = {0.0, 1.0};
  path.points = {place, place};
  return path;
}

void read_positive(const TomlTable& table, std::string_view key, std::string_view unit,
                   double& value) {
  if (const auto found = table.find(key)) value = found->positive(unit);
}

std::string read_region_name(const TomlTable& table, const Cloth& cloth) {
  const TomlValue region = table.require("region", "the name of a region of the cloth");
  std::string name = region.identifier();
  const bool is_known = std::any_of(cloth.regions.begin(), cloth.regions.end(),
                                    [&](const Region& r) { return r.name == name; });
  if (!is_known) region.fail("expected a region of the cloth '" + cloth.name + "'");
  return name;
}

Seek read_seek(const TomlTable& table, const Scene& scene) {
  table.allow(kSeekKeys);
  Seek seek;
  const Cloth& cloth = read_cloth_name(table, scene);
  seek.cloth = cloth.name;
  seek.region = read_region_name(table, cloth);
  seek.target = read_target(table);
  if (const auto front = table.find("front")) {
    seek.front = front->vector("1");
    if (seek.front.x() == 0 && seek.front.z() == 0) {
      front->fail("has no horizontal part, expected a direction such as [0, 0, 1]");
    }
  }
  read_positive(table, "speed", "m/s", seek.speed);
  if (const auto force = table.find("force")) seek.force = force->non_negative("N");
  read_positive(table, "turn_rate", "rad/s", seek.turn_rate);
  if (const auto torque = table.find("torque")) seek.torque = torque->non_negative("N*m");
  read_positive(table, "arrival", "m", seek.arrival);
  return seek;
}

Roll read_roll(const TomlTable& table, const Scene& scene) {
  table.allow(kRollKeys);
  Roll roll;
  roll.cloth = read_cloth_name(table, scene).name;
  roll.target = read_target(table);
  read_positive(table, "turn_rate", "rad/s", roll.turn_rate);
  if (const auto torque = table.find("torque")) roll.torque = torque->non_negative("N*m");
  read_positive(table, "arrival", "m", roll.arrival);
  return roll;
}

DetailSwitch read_switch(const TomlValue& value) {
  const TomlTable table = value.table("{ time = \"0 s\", level = \"full\" }");
  table.allow(kSwitchKeys);
  const TomlValue time = table.require("time", "a time of the run");
  const TomlValue level = table.require("level", "one of full, simplified, skin");
  return {time.non_negative("s"),
          static_cast<DetailLevel>(level.choice(kDetailWords, "level of detail"))};
}

/// A cloth that keeps its nodes: one that does not tear.
const Cloth& read_whole_cloth(const TomlTable& table, const Scene& scene) {
  const Cloth& cloth = read_cloth_name(table, scene);
  if (cloth.tear) table.require("cloth", "").fail("tears, expected a cloth that does not");
  return cloth;
}

Attach read_attach(const TomlTable& table, const Scene& scene) {
  table.allow(kAttachKeys);
  Attach attach;
  const Cloth& cloth = read_whole_cloth(table, scene);
  attach.cloth = cloth.name;
  attach.region = read_region_name(table, cloth);
  const TomlValue to = table.require("to", "the name of a collider");
  attach.to = to.identifier();
  const bool is_known = std::any_of(scene.colliders.begin(), scene.colliders.end(),
                                    [&](const Collider& c) { return c.name == attach.to; });
  if (!is_known) to.fail("expected the name of a collider of this scene");
  attach.stiffness = table.require("stiffness", expected_quantity("N/m")).positive("N/m");
  if (const auto damping = table.find("damping")) attach.damping = damping->non_negative("N*s/m");
  return attach;
}

Detail read_detail(const TomlTable& table, const Scene& scene) {
  table.allow(kDetailKeys);
  Detail detail;
  detail.cloth = read_whole_cloth(table, scene).name;
  const std::string expected = "a list of { time, level }";
  for (const TomlValue& entry : table.require("levels", expected).items(expected)) {
    detail.levels.push_back(read_switch(entry));
    if (detail.levels.size() > 1 &&
        detail.levels.back().time <= detail.levels[detail.levels.size() - 2].time) {
      entry.fail("is not later than the one before, expected growing times");
    }
  }
  if (const auto blend = table.find("blend")) detail.blend = blend->non_negative("s");
  read_positive(table, "follow", "Hz", detail.follow);
  return detail;
}

}  // namespace

ControllerSettings read_controller(const TomlTable& table, const Scene& scene) {
  const TomlValue kind = table.require("kind", "one of seek, roll, attach, detail");
  switch (kind.choice(kControllerWords, "kind of controller")) {
    case 0:
      return read_seek(table, scene);
    case 1:
      return read_roll(table, scene);
    case 2:
      return read_attach(table, scene);
    default:
      return read_detail(table, scene);
  }
}

}  // namespace weft::scenes
