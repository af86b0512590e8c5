#include <weft/viewer/live/live_source.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/viewer/model/cloth_type.hpp>

namespace weft::viewer {
namespace {

const scenes::EngineInfo* engine_named(const std::string& name) {
  for (const scenes::EngineInfo& engine : scenes::engine_table()) {
    if (engine.name == name) return &engine;
  }
  return nullptr;
}

}  // namespace

LiveSource::LiveSource(LiveSettings settings)
    : settings_(std::move(settings)), is_playing_(settings_.is_running) {
  written_ = scenes::load_scene(settings_.name);
  if (settings_.engine.empty()) {
    settings_.engine = written_.engines.empty() ? std::string(scenes::kReferenceEngine.name)
                                                : written_.engines.front();
  }
  const std::vector<std::string> known = engines();
  if (std::find(known.begin(), known.end(), settings_.engine) == known.end()) {
    throw InvalidArgument(
        fmt::format("--engine {}: scene '{}' is not made for it, expected one of {}",
                    settings_.engine, written_.name, fmt::join(known, ", ")));
  }
  written_ = scenes::with_step_of(std::move(written_), settings_.engine);
  scene_ = written_;
  start(is_playing_);
}

std::vector<std::string> LiveSource::engines() const {
  std::vector<std::string> names;
  for (const scenes::EngineInfo& engine : scenes::engine_table()) {
    if (scenes::is_for_engine(written_, engine.name)) names.emplace_back(engine.name);
  }
  return names;
}

void LiveSource::start(bool is_running) {
  SimulationSettings settings;
  settings.scene = scene_;
  settings.engine = engine_named(settings_.engine);
  settings.is_running = is_running;
  settings.speed = settings_.speed;
  settings.has_other_laws = has_other_laws_;
  settings.record = std::exchange(settings_.record, {});
  settings.provenance = settings_.provenance;
  settings.provenance["engine"] = settings_.engine;
  settings.provenance["precision"] = scenes::to_string(settings.engine->precision);
  // The thread of the run before ends first: two at once would share the processor.
  simulation_.reset();
  simulation_ = std::make_unique<Simulation>(std::move(settings));
  looked_back_ = nullptr;
  is_playing_ = is_running;
  ++version_;
}

SnapshotPtr LiveSource::shown() {
  return looked_back_ ? looked_back_ : simulation_->latest();
}

void LiveSource::update(double /*seconds*/) {
  if (const std::string refusal = simulation_->take_refusal(); !refusal.empty()) {
    message_ = refusal + "; R starts again with the new laws";
  }
  if (const auto failure = simulation_->failure()) message_ = *failure;
}

std::string LiveSource::take_message() {
  return std::exchange(message_, {});
}

void LiveSource::set_speed(double speed) {
  settings_.speed = speed;
  simulation_->set_speed(speed);
}

int LiveSource::num_frames() const {
  return static_cast<int>(simulation_->num_frames());
}

int LiveSource::frame() const {
  const std::vector<SnapshotPtr> frames = simulation_->frames();
  const auto last = static_cast<int>(frames.size()) - 1;
  if (!looked_back_) return last;
  const auto found = std::find(frames.begin(), frames.end(), looked_back_);
  return found == frames.end() ? 0 : static_cast<int>(found - frames.begin());
}

double LiveSource::frame_time(int frame) const {
  return simulation_->frame(static_cast<std::size_t>(frame))->state.time;
}

void LiveSource::seek(int frame) {
  const std::vector<SnapshotPtr> frames = simulation_->frames();
  if (frames.empty()) return;
  const auto last = static_cast<int>(frames.size()) - 1;
  if (is_playing_) {
    is_playing_ = false;
    simulation_->set_running(false);
  }
  looked_back_ =
      frame >= last ? nullptr : frames[static_cast<std::size_t>(std::clamp(frame, 0, last))];
}

void LiveSource::reload() {
  try {
    written_ = scenes::with_step_of(scenes::load_scene(settings_.name), settings_.engine);
  } catch (const Error& error) {
    message_ = error.what();
    return;
  }
  scene_ = written_;
  has_other_laws_ = false;
  cloth_type_ = 0;
  start(is_playing_);
  message_ = settings_.name + ": read again";
}

void LiveSource::set_engine(const std::string& name) {
  settings_.engine = name;
  try {
    const scenes::World world =
        scenes::with_step_of(scenes::load_scene(settings_.name), name).world;
    written_.world.time_step = world.time_step;
    written_.world.frame_interval = world.frame_interval;
    scene_.world.time_step = world.time_step;
    scene_.world.frame_interval = world.frame_interval;
  } catch (const Error& error) {
    message_ = error.what();
    return;
  }
  start(is_playing_);
  message_ = "engine " + name;
}

void LiveSource::set_cloth_type(std::size_t type) {
  cloth_type_ = type;
  const bool is_held = settings_.engine == scenes::kBulletSoft.name ||
                       settings_.engine == scenes::kBulletDeformable.name;
  const std::string note = apply_cloth_type(scene_, written_, type, is_held);
  message_ = note.empty() ? "cloth: " + std::string(cloth_types()[type].name) : note;
  send_laws();
}

void LiveSource::set_parameter(const Parameter& parameter, double value) {
  try {
    viewer::set_parameter(scene_, parameter, value);
  } catch (const InvalidArgument& error) {
    message_ = error.what();
    return;
  }
  has_other_laws_ = true;
  simulation_->set_laws(parameter.cloth, scene_.cloths[parameter.cloth].laws);
}

void LiveSource::send_laws() {
  has_other_laws_ = true;
  for (std::size_t c = 0; c < scene_.cloths.size(); ++c) {
    simulation_->set_laws(c, scene_.cloths[c].laws);
  }
}

std::vector<PlotPoint> LiveSource::plot() const {
  std::vector<PlotPoint> points;
  for (const SnapshotPtr& frame : simulation_->frames()) {
    points.push_back({frame->state.time, frame->measures, frame->step_time});
  }
  return points;
}

void LiveSource::describe(nlohmann::json& json) const {
  const Vector3<double> wind = wind_of(scene_);
  const Vector3<double> gravity = gravity_of(scene_);
  json["kind"] = "live";
  json["scene"] = scene_.name;
  json["engine"] = settings_.engine;
  json["cloth_type"] = std::string(cloth_types()[cloth_type_].name);
  json["wind"] = {wind.x(), wind.y(), wind.z()};
  json["gravity"] = {gravity.x(), gravity.y(), gravity.z()};
  json["looks_back"] = looked_back_ != nullptr;
  nlohmann::json& laws = json["laws"] = nlohmann::json::object();
  for (const Parameter& parameter : parameters_of(scene_)) {
    laws[scene_.cloths[parameter.cloth].name + " " + parameter.label] = parameter.value;
  }
}

}  // namespace weft::viewer
