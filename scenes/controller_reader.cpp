#include <algorithm>
#include <array>

#include <weft/scenes/scene_reader.hpp>
#include <weft/scenes/scene_words.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 10> kSeekKeys = {"kind",   "cloth",  "region", "target",
                                                        "front",  "speed",  "force",  "turn_rate",
                                                        "torque", "arrival"};
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

Seek read_seek(const TomlTable& table, const Scene& scene) {
  table.allow(kSeekKeys);
  Seek seek;
  const Cloth& cloth = read_cloth_name(table, scene);
  seek.cloth = cloth.name;
  const TomlValue region = table.require("region", "the name of a region of the cloth");
  seek.region = region.identifier();
  const bool is_known = std::any_of(cloth.regions.begin(), cloth.regions.end(),
                                    [&](const Region& r) { return r.name == seek.region; });
  if (!is_known) region.fail("expected a region of the cloth '" + cloth.name + "'");
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

}  // namespace

ControllerSettings read_controller(const TomlTable& table, const Scene& scene) {
  const TomlValue kind = table.require("kind", "one of seek, roll");
  if (kind.choice(kControllerWords, "kind of controller") == 0) return read_seek(table, scene);
  return read_roll(table, scene);
}

}  // namespace weft::scenes
