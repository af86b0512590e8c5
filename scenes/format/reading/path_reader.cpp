// Tested by tests/scenes/format/scene_file_test.cpp.

#include <array>

#include <weft/core/error.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>
#include <weft/scenes/format/scene_words.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 7> kPathKeys = {"times",  "points",    "loop", "ease_in",
                                                       "follow", "turn_axis", "turns"};

}  // namespace

Path read_path(const TomlValue& value) {
  const std::string example =
      "a table such as { times = [\"0 s\", \"1 s\"], points = [[\"0 m\", \"0 m\", \"0 m\"], "
      "[\"1 m\", \"0 m\", \"0 m\"]] }";
  const TomlTable table = value.table(example);
  table.allow(kPathKeys);
  Path path;
  const std::string times = "an array such as [\"0 s\", \"1 s\"]";
  for (const TomlValue& time : table.require("times", times).items(times)) {
    path.times.push_back(time.quantity("s"));
  }
  const std::string points = "an array of points, one for each time";
  for (const TomlValue& point : table.require("points", points).items(points)) {
    path.points.push_back(point.vector("m"));
  }
  if (const auto loop = table.find("loop")) path.loop = loop->boolean();
  if (const auto ease_in = table.find("ease_in")) path.ease_in = ease_in->non_negative("s");
  if (const auto follow = table.find("follow")) {
    path.follow = static_cast<PathFollow>(follow->choice(kFollowWords, "way to follow"));
  }
  if (const auto axis = table.find("turn_axis")) path.turn_axis = axis->vector("1");
  if (const auto turns = table.find("turns")) {
    for (const TomlValue& turn : turns->items("an array of angles, one for each time")) {
      path.turns.push_back(turn.quantity("rad"));
    }
  }
  try {
    (void)PathMotion(path);
  } catch (const InvalidArgument& error) {
    value.fail(error.what());
  }
  return path;
}

}  // namespace weft::scenes
