#include <weft/scenes/format/reading/scene_reader.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include <weft/scenes/engine_kind.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/appearance_reader.hpp>
#include <weft/scenes/format/scene_words.hpp>

namespace weft::scenes {
namespace {

constexpr int kMaxPositionIterations = 100'000;

/// frame_interval / time_step may differ from a whole number by this share [-]: far above the
/// rounding of both, and after kMaxSteps steps the recording is still only 1/100 of a step off.
constexpr double kWholeStepTolerance = 1e-9;

constexpr std::array<std::string_view, 12> kRootKeys = {
    "character", "schema",   "name",       "summary", "engines",   "world",
    "cloth",     "collider", "controller", "bullet",  "reference", "camera"};
constexpr std::array<std::string_view, 5> kWorldKeys = {"gravity", "time_step", "duration",
                                                        "frame_interval", "implicit_time_step"};
constexpr std::array<std::string_view, 2> kBulletKeys = {"position_iterations", "concave"};
constexpr std::array<std::string_view, 6> kReferenceKeys = {
    "integrator", "tolerance", "spectral_radius", "contact", "contact_points", "step_guard"};
constexpr std::array<std::string_view, 5> kCameraKeys = {"position", "target", "field_of_view",
                                                         "follow", "poster_time"};

void check_schema(const TomlTable& root) {
  const std::string expected = fmt::format("schema = \"{}\"", kSchema);
  const TomlValue schema = root.require("schema", expected);
  if (schema.text() != kSchema)
    schema.fail(fmt::format("unknown version, expected \"{}\"", kSchema));
}

std::string read_name(const TomlTable& root) {
  const TomlValue value = root.require("name", "a name such as \"drape_sphere\"");
  std::string name = value.identifier();
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (!std::all_of(name.begin(), name.end(), allowed)) {
    value.fail("expected lower-case letters, digits and '_' only");
  }
  return name;
}

constexpr auto kEngineWords = [] {
  std::array<std::string_view, kEngineKinds.size()> words;
  for (std::size_t e = 0; e < words.size(); ++e) words[e] = kEngineKinds[e].name;
  return words;
}();

std::vector<std::string> read_engines(const TomlValue& value) {
  std::vector<std::string> engines;
  for (const TomlValue& item : value.items("a list of engines such as [\"bullet_soft\"]")) {
    std::string engine(kEngineWords[item.choice(kEngineWords, "engine")]);
    if (std::find(engines.begin(), engines.end(), engine) != engines.end()) {
      item.fail("expected each engine once");
    }
    engines.push_back(std::move(engine));
  }
  if (engines.empty()) value.fail("is empty, expected at least one engine, or no such key");
  return engines;
}

void check_steps(const World& world, double time_step, const TomlTable& table) {
  const TomlValue duration = table.require("duration", "");
  if (world.duration < time_step) {
    duration.fail(
        fmt::format("expected at least one time step, {}", format_quantity(time_step, "s")));
  }
  const double num_steps = world.duration / time_step;
  if (num_steps > kMaxSteps) {
    duration.fail(fmt::format("makes {:.3g} time steps of {}, expected at most {}", num_steps,
                              format_quantity(time_step, "s"), kMaxSteps));
  }
  const double ratio = world.frame_interval / time_step;
  const double whole = std::round(ratio);
  if (whole >= 1 && std::abs(ratio - whole) <= kWholeStepTolerance * whole) return;
  const std::string message =
      fmt::format("is {:.6g} time steps, expected a whole number of them, {} each", ratio,
                  format_quantity(time_step, "s"));
  if (const std::optional<TomlValue> interval = table.find("frame_interval")) {
    interval->fail(message);
  }
  table.fail(fmt::format("frame_interval, by default {}, {}",
                         format_quantity(world.frame_interval, "s"), message));
}

BulletSettings read_bullet(const TomlTable& table) {
  table.allow(kBulletKeys);
  BulletSettings settings;
  if (const auto value = table.find("position_iterations")) {
    settings.position_iterations = value->integer(1, kMaxPositionIterations);
  }
  if (const auto value = table.find("concave")) {
    settings.concave = static_cast<ConcaveContact>(value->choice(kConcaveWords, "contact"));
  }
  return settings;
}

ReferenceSettings read_reference(const TomlTable& table) {
  table.allow(kReferenceKeys);
  ReferenceSettings settings;
  if (const auto value = table.find("integrator")) {
    settings.integrator = static_cast<Integrator>(value->choice(kIntegratorWords, "integrator"));
  }
  if (const auto value = table.find("tolerance")) settings.tolerance = value->positive("1");
  if (const auto value = table.find("spectral_radius")) {
    settings.spectral_radius = value->non_negative("1");
    if (settings.spectral_radius > 1.0) value->fail("expected 0 to 1");
  }
  if (const auto value = table.find("contact_points")) {
    settings.contact_points =
        static_cast<ContactPoints>(value->choice(kContactPointsWords, "contact points"));
  }
  if (const auto value = table.find("contact")) {
    settings.contact = static_cast<ContactModel>(value->choice(kContactWords, "contact model"));
  }
  if (const auto value = table.find("step_guard")) {
    settings.step_guard = static_cast<StepGuard>(value->choice(kStepGuardWords, "step guard"));
  }
  return settings;
}

void check_follow(const TomlValue& value, const std::string& name, const Scene& scene) {
  const auto has_name = [&](const auto& body) { return body.name == name; };
  if (std::any_of(scene.cloths.begin(), scene.cloths.end(), has_name)) return;
  if (std::any_of(scene.colliders.begin(), scene.colliders.end(), has_name)) return;
  value.fail("no body has this name, expected a cloth or a collider");
}

Camera read_camera(const TomlTable& table, const Scene& scene) {
  table.allow(kCameraKeys);
  Camera camera;
  if (const auto value = table.find("position")) camera.position = value->vector("m");
  if (const auto value = table.find("target")) camera.target = value->vector("m");
  if (const auto value = table.find("field_of_view")) {
    camera.field_of_view = value->positive("rad");
    if (camera.field_of_view >= std::numbers::pi) value->fail("expected an angle < 180 deg");
  }
  if (const auto value = table.find("follow")) {
    camera.follow = value->identifier();
    check_follow(*value, camera.follow, scene);
  }
  if (const auto value = table.find("poster_time")) {
    camera.poster_time = value->non_negative("s");
  }
  if (camera.position == camera.target) table.fail("position = target, expected two points");
  return camera;
}

/// After the cloths, so that theirs come after these; names: of all bodies.
void read_characters(const TomlTable& root, std::set<std::string>& names, Scene& scene) {
  for (const TomlTable& table : root.tables("character")) {
    const std::size_t first_cloth = scene.cloths.size();
    const std::size_t first_collider = scene.colliders.size();
    read_character(table, scene);
    const auto claim = [&](const std::string& name) {
      if (names.insert(name).second) return;
      table.fail("has a body '" + name + "', but another body has this name, expected its own");
    };
    for (std::size_t c = first_cloth; c < scene.cloths.size(); ++c) claim(scene.cloths[c].name);
    for (std::size_t k = first_collider; k < scene.colliders.size(); ++k) {
      claim(scene.colliders[k].name);
    }
  }
}

void read_bodies(const TomlTable& root, Scene& scene) {
  std::set<std::string> names;
  const auto claim = [&](const TomlTable& table, const std::string& name) {
    if (!names.insert(name).second) {
      table.require("name", "").fail("another body has this name, expected a name of its own");
    }
  };
  long long num_nodes = 0;
  for (const TomlTable& table : root.tables("cloth")) {
    const Cloth& cloth = scene.cloths.emplace_back(read_cloth(table, scene.world));
    claim(table, cloth.name);
    num_nodes += scenes::num_nodes(cloth.source);
    if (num_nodes > kMaxNodes) {
      table.fail(fmt::format("the cloths have {} nodes in all, expected at most {}", num_nodes,
                             kMaxNodes));
    }
  }
  read_characters(root, names, scene);
  if (scene.cloths.empty()) root.fail("no cloth, expected at least one table [[cloth]]");
  for (const TomlTable& table : root.tables("collider")) {
    scene.colliders.push_back(read_collider(table));
    claim(table, scene.colliders.back().name);
  }
  for (const TomlTable& table : root.tables("cloth")) check_carriers(table, scene);
  for (const TomlTable& table : root.tables("controller")) {
    scene.controllers.push_back(read_controller(table, scene));
  }
}

}  // namespace

World read_world(const TomlTable& table) {
  table.allow(kWorldKeys);
  World world;
  if (const auto value = table.find("gravity")) world.gravity = value->vector("m/s^2");
  world.time_step = table.require("time_step", expected_quantity("s", "1/100")).positive("s");
  world.duration = table.require("duration", expected_quantity("s")).positive("s");
  if (const auto value = table.find("frame_interval")) world.frame_interval = value->positive("s");
  check_steps(world, world.time_step, table);
  if (const auto value = table.find("implicit_time_step")) {
    world.implicit_time_step = value->positive("s");
    check_steps(world, *world.implicit_time_step, table);
  }
  return world;
}

Scene read_scene(const TomlTable& root) {
  check_schema(root);
  root.allow(kRootKeys);
  Scene scene;
  scene.name = read_name(root);
  if (const auto value = root.find("summary")) scene.summary = value->text();
  if (const auto value = root.find("engines")) scene.engines = read_engines(*value);
  const std::string world = "a table [world] with time_step and duration";
  scene.world = read_world(root.require("world", world).table(world));
  read_bodies(root, scene);
  load_appearance_files(root, scene);
  if (const auto value = root.find("bullet")) scene.bullet = read_bullet(value->table("a table"));
  if (const auto value = root.find("reference")) {
    scene.reference = read_reference(value->table("a table"));
  }
  if (const auto value = root.find("camera"))
    scene.camera = read_camera(value->table("a table"), scene);
  return scene;
}

}  // namespace weft::scenes
