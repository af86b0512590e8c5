// Tested by tests/scenes/format/scene_file_test.cpp, tests/scenes/body_sources_test.cpp.

#include <string>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/scenes/format/reading/appearance_reader.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/format/scene_text.hpp>
#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/format/text_guard.hpp>
#include <weft/scenes/format/toml_text.hpp>
#include <weft/scenes/format/writing/shape_writer.hpp>

namespace weft::scenes {
namespace {

/// 0 for the first, 1 for the last row or column.
int side_index(int side) {
  if (side != 0 && side != -1) {
    throw InvalidArgument(
        fmt::format("write_scene: pin side = {}, expected 0 (first) or -1 (last)", side));
  }
  return -side;
}

std::string pin_text(const CornerPin& pin) {
  const int index = side_index(pin.u) + 2 * side_index(pin.v);
  return fmt::format("{{ corner = {} }}", word(kCornerWords, index));
}

std::string pin_text(const EdgePin& pin) {
  return fmt::format("{{ edge = {} }}", word(kEdgeWords, 2 * pin.axis + side_index(pin.side)));
}

std::string pin_text(const BoxPin& pin) {
  return fmt::format("{{ box = {{ min = {}, max = {} }} }}", vector_text(pin.minimum, "m"),
                     vector_text(pin.maximum, "m"));
}

std::string pin_text(const SpherePin& pin) {
  return fmt::format("{{ sphere = {{ center = {}, radius = {} }} }}", vector_text(pin.center, "m"),
                     value_text(pin.radius, "m"));
}

/// Runs of nodes as "first-last".
std::string pin_text(const NodePin& pin) {
  std::string text;
  for (std::size_t first = 0; first < pin.nodes.size();) {
    std::size_t last = first;
    while (last + 1 < pin.nodes.size() && pin.nodes[last + 1] == pin.nodes[last] + 1) ++last;
    text += text.empty() ? "" : ", ";
    text += first == last ? std::to_string(pin.nodes[first])
                          : fmt::format("\"{}-{}\"", pin.nodes[first], pin.nodes[last]);
    first = last + 1;
  }
  return "{ nodes = [" + text + "] }";
}

std::string pins_text(const std::vector<Pin>& pins) {
  std::string text;
  for (const Pin& pin : pins) {
    text += (text.empty() ? "" : ", ") + std::visit([](const auto& p) { return pin_text(p); }, pin);
  }
  return "[" + text + "]";
}

template <class Values, class Text>
std::string array_text(const Values& values, const Text& text_of) {
  std::string text;
  for (const auto& value : values) text += (text.empty() ? "" : ", ") + text_of(value);
  return "[" + text + "]";
}

std::string path_text(const Path& path) {
  const auto time = [](double t) { return value_text(t, "s"); };
  const auto angle = [](double a) { return value_text(a, "rad"); };
  const auto point = [](const Vector3<double>& p) { return vector_text(p, "m"); };
  std::string turns;
  if (!path.turns.empty()) {
    turns = fmt::format(", turn_axis = {}, turns = {}", vector_text(path.turn_axis, "1"),
                        array_text(path.turns, angle));
  }
  return fmt::format("{{ times = {}, points = {}, loop = {}, ease_in = {}, follow = {}{} }}",
                     array_text(path.times, time), array_text(path.points, point), path.loop,
                     value_text(path.ease_in, "s"), word(kFollowWords, path.follow), turns);
}

std::string motion_text(const MovingPin& pin) {
  if (!pin.to.empty()) return "to = " + toml_string(pin.to);
  return pin.path ? "path = " + path_text(*pin.path)
                  : "velocity = " + vector_text(pin.velocity, "m/s");
}

std::string all_pins_text(const Cloth& cloth) {
  std::string text = pins_text(cloth.pins);
  for (const MovingPin& pin : cloth.moving_pins) {
    const std::string nodes = std::visit([](const auto& p) { return pin_text(p); }, pin.nodes);
    text.pop_back();
    text += fmt::format("{}{}, {} }}]", text.size() > 1 ? ", " : "",
                        nodes.substr(0, nodes.size() - 2), motion_text(pin));
  }
  return text;
}

std::string connection_text(const Connection& connection) {
  const std::string node = connection.node_number
                               ? std::to_string(*connection.node_number)
                               : fmt::format("[{}, {}]", connection.node[0], connection.node[1]);
  return fmt::format("{{ name = {}, node = {}{} }}", toml_string(connection.name), node,
                     connection.to.empty() ? "" : ", to = " + pins_text(connection.to));
}

std::string tear_text(const ClothTear& tear) {
  std::string weak;
  for (const WeakRegion& region : tear.rule.weak) {
    weak += fmt::format("{}{{ region = {}, strain = {} }}", weak.empty() ? "" : ", ",
                        toml_string(region.node_set), value_text(region.strain, "1"));
  }
  std::string cuts;
  for (const Blade& cut : tear.cuts) {
    cuts += fmt::format("{}{{ from = {}, to = {}, depth = {} }}", cuts.empty() ? "" : ", ",
                        vector_text(cut.from, "m"), vector_text(cut.to, "m"),
                        vector_text(cut.depth, "m"));
  }
  return fmt::format("{{ strain = {}, variation = {}, max_splits = {}, weak = [{}], cut = [{}] }}",
                     value_text(tear.rule.strain, "1"), value_text(tear.rule.variation, "1"),
                     tear.rule.max_splits, weak, cuts);
}

}  // namespace

void write_law(std::string& out, std::string_view path, const forces::LawSpecification& law) {
  const forces::LawInfo* info = forces::find_law(law.law);
  if (info == nullptr) {
    throw InvalidArgument("write_scene: law = '" + law.law + "', expected a registered law");
  }
  out += fmt::format("\n[[{}]]\n", path);
  line(out, "law", toml_string(law.law));
  if (!law.sets.empty()) {
    std::string sets;
    for (const std::string& set : law.sets) sets += (sets.empty() ? "" : ", ") + toml_string(set);
    line(out, set_key(info->traits.elements), "[" + sets + "]");
  }
  const forces::LawSpecification full = forces::checked(law);
  for (const forces::ParameterInfo& parameter : info->parameters) {
    const std::vector<double>& values = full.parameters.at(std::string(parameter.name));
    line(
        out, parameter.name,
        parameter.size == 3
            ? vector_text(Vector3<double>(values.at(0), values.at(1), values.at(2)), parameter.unit)
            : value_text(values.at(0), parameter.unit));
  }
}

namespace {

void write_cloth(std::string& out, const Cloth& cloth) {
  out += "\n[[cloth]]\n";
  line(out, "name", toml_string(cloth.name));
  write_source(out, cloth.source);
  if (cloth.bulge) {
    line(out, "bulge",
         fmt::format("{{ height = {}, radius = {} }}", value_text(cloth.bulge->height, "m"),
                     value_text(cloth.bulge->radius, "m")));
  }
  line(out, "velocity", vector_text(cloth.velocity, "m/s"));
  line(out, "collision_margin", value_text(cloth.collision_margin, "m"));
  line(out, "friction", value_text(cloth.friction, "1"));
  line(out, "pin", all_pins_text(cloth));
  if (cloth.self_collision) line(out, "self_collision", "true");
  if (cloth.self_thickness) line(out, "self_thickness", value_text(*cloth.self_thickness, "m"));
  if (cloth.soft_collision) line(out, "soft_collision", "true");
  if (!cloth.connections.empty()) {
    std::string connections;
    for (const Connection& connection : cloth.connections) {
      connections += (connections.empty() ? "" : ", ") + connection_text(connection);
    }
    line(out, "connection", "[" + connections + "]");
  }
  if (!cloth.regions.empty()) {
    std::string regions;
    for (const Region& region : cloth.regions) {
      regions +=
          fmt::format("{}{{ name = {}, nodes = {}, springs = {} }}", regions.empty() ? "" : ", ",
                      toml_string(region.name), pins_text(region.nodes), region.has_springs);
    }
    line(out, "region", "[" + regions + "]");
  }
  if (cloth.tear) line(out, "tear", tear_text(*cloth.tear));
  out += write_appearance(cloth.appearance);
  if (cloth.drawn_mesh) write_drawn_mesh(out, *cloth.drawn_mesh);
  for (const forces::LawSpecification& law : cloth.laws) write_law(out, "cloth.law", law);
}

}  // namespace

void write_collider_keys(std::string& out, const Collider& collider) {
  line(out, "name", toml_string(collider.name));
  out += shape_text(collider.shape);
  if (collider.path) {
    line(out, "path", path_text(*collider.path));
  } else {
    line(out, "position", vector_text(collider.position, "m"));
  }
  line(out, "orientation", orientation_text(collider.orientation));
  line(out, "friction", value_text(collider.friction, "1"));
  out += write_appearance(collider.appearance);
  if (!collider.mass) return;
  line(out, "mass", value_text(*collider.mass, "kg"));
  line(out, "velocity", vector_text(collider.velocity, "m/s"));
  line(out, "angular_velocity", vector_text(collider.angular_velocity, "rad/s"));
}

namespace {

void write_controller(std::string& out, const Seek& seek) {
  line(out, "kind", toml_string("seek"));
  line(out, "cloth", toml_string(seek.cloth));
  line(out, "region", toml_string(seek.region));
  line(out, "target", path_text(seek.target));
  line(out, "front", vector_text(seek.front, "1"));
  line(out, "speed", value_text(seek.speed, "m/s"));
  line(out, "force", value_text(seek.force, "N"));
  line(out, "turn_rate", value_text(seek.turn_rate, "rad/s"));
  line(out, "torque", value_text(seek.torque, "N*m"));
  line(out, "arrival", value_text(seek.arrival, "m"));
}

void write_controller(std::string& out, const Roll& roll) {
  line(out, "kind", toml_string("roll"));
  line(out, "cloth", toml_string(roll.cloth));
  line(out, "target", path_text(roll.target));
  line(out, "turn_rate", value_text(roll.turn_rate, "rad/s"));
  line(out, "torque", value_text(roll.torque, "N*m"));
  line(out, "arrival", value_text(roll.arrival, "m"));
}

void write_controller(std::string& out, const Attach& attach) {
  line(out, "kind", toml_string("attach"));
  line(out, "cloth", toml_string(attach.cloth));
  line(out, "region", toml_string(attach.region));
  line(out, "to", toml_string(attach.to));
  line(out, "stiffness", value_text(attach.stiffness, "N/m"));
  line(out, "damping", value_text(attach.damping, "N*s/m"));
}

void write_controller(std::string& out, const Detail& detail) {
  line(out, "kind", toml_string("detail"));
  line(out, "cloth", toml_string(detail.cloth));
  std::string levels;
  for (const DetailSwitch& entry : detail.levels) {
    levels += (levels.empty() ? "" : ", ");
    levels += "{ time = " + value_text(entry.time, "s") +
              ", level = " + word(kDetailWords, entry.level) + " }";
  }
  line(out, "levels", "[" + levels + "]");
  line(out, "blend", value_text(detail.blend, "s"));
  line(out, "follow", value_text(detail.follow, "Hz"));
}

void write_settings(std::string& out, const Scene& scene) {
  out += "\n[bullet]\n";
  line(out, "position_iterations", std::to_string(scene.bullet.position_iterations));
  line(out, "concave", word(kConcaveWords, scene.bullet.concave));
  out += "\n[reference]\n";
  line(out, "integrator", word(kIntegratorWords, scene.reference.integrator));
  line(out, "tolerance", value_text(scene.reference.tolerance, "1"));
  line(out, "spectral_radius", value_text(scene.reference.spectral_radius, "1"));
  line(out, "contact", word(kContactWords, scene.reference.contact));
  line(out, "contact_points", word(kContactPointsWords, scene.reference.contact_points));
  line(out, "step_guard", word(kStepGuardWords, scene.reference.step_guard));
  out += "\n[camera]\n";
  line(out, "position", vector_text(scene.camera.position, "m"));
  line(out, "target", vector_text(scene.camera.target, "m"));
  line(out, "field_of_view", value_text(scene.camera.field_of_view, "rad"));
  if (!scene.camera.follow.empty()) line(out, "follow", toml_string(scene.camera.follow));
  if (scene.camera.poster_time) {
    line(out, "poster_time", value_text(*scene.camera.poster_time, "s"));
  }
}

}  // namespace

std::string write_scene(const Scene& scene) {
  std::string out;
  line(out, "schema", toml_string(kSchema));
  line(out, "name", toml_string(scene.name));
  line(out, "summary", toml_string(scene.summary));
  if (!scene.engines.empty()) {
    std::string engines;
    for (const std::string& engine : scene.engines) {
      engines += (engines.empty() ? "" : ", ") + toml_string(engine);
    }
    line(out, "engines", "[" + engines + "]");
  }
  out += "\n[world]\n";
  line(out, "gravity", vector_text(scene.world.gravity, "m/s^2"));
  line(out, "time_step", value_text(scene.world.time_step, "s"));
  line(out, "duration", value_text(scene.world.duration, "s"));
  line(out, "frame_interval", value_text(scene.world.frame_interval, "s"));
  if (scene.world.implicit_time_step) {
    line(out, "implicit_time_step", value_text(*scene.world.implicit_time_step, "s"));
  }
  for (const Cloth& cloth : scene.cloths) {
    if (!std::holds_alternative<SkinSource>(cloth.source)) write_cloth(out, cloth);
  }
  for (const CharacterSettings& character : scene.characters) {
    write_character(out, character, scene);
  }
  for (const Collider& collider : scene.colliders) {
    if (!collider.led_by.empty()) continue;
    out += "\n[[collider]]\n";
    write_collider_keys(out, collider);
  }
  for (const ControllerSettings& settings : scene.controllers) {
    out += "\n[[controller]]\n";
    std::visit([&](const auto& controller) { write_controller(out, controller); }, settings);
  }
  write_settings(out, scene);
  if (out.size() > kMaxTextSize) {
    throw InvalidArgument(
        fmt::format("write_scene: the resolved scene has {} bytes, expected at most {}: its meshes "
                    "are too large",
                    out.size(), kMaxTextSize));
  }
  return out;
}

}  // namespace weft::scenes
