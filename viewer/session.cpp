#include <weft/viewer/session.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/viewer/model/orbit.hpp>
#include <weft/viewer/recorded/recorded_source.hpp>

namespace weft::viewer {
namespace {

constexpr double kMessageTime = 6.0;      // [s]
constexpr double kTurnOfPicture = 3.0;    // [rad] for a drag over the height of the picture
constexpr double kZoomOfNotch = 1.1;      // [-]
constexpr double kParameterFactor = 1.1;  // [-]
constexpr double kParameterStep = 0.1;    // of a parameter that is 0

bool is_recording(const std::string& name) {
  return name.ends_with(".weftrec");
}

}  // namespace

Session::Session(SessionSettings settings) : settings_(std::move(settings)) {
  if (settings_.files.empty()) settings_.files.emplace_back("drape_sphere");
  const auto num_recordings =
      std::count_if(settings_.files.begin(), settings_.files.end(), &is_recording);
  if (num_recordings > 0 && num_recordings < std::ssize(settings_.files)) {
    throw InvalidArgument(
        "scenes and recordings together, expected scenes alone, or recordings alone");
  }
  list_ = settings_.files;
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) {
    const std::string name(entry.name);
    if (std::find(list_.begin(), list_.end(), name) == list_.end()) list_.push_back(name);
  }
  view_.style = settings_.style;
  show(settings_.files.front());
}

void Session::show(const std::string& name) {
  std::unique_ptr<Source> source;
  LiveSource* live = nullptr;
  if (is_recording(name)) {
    std::vector<std::filesystem::path> paths(settings_.files.begin(), settings_.files.end());
    source = std::make_unique<RecordedSource>(paths);
  } else {
    LiveSettings live_settings = settings_.live;
    live_settings.name = name;
    auto made = std::make_unique<LiveSource>(std::move(live_settings));
    live = made.get();
    source = std::move(made);
    // Only the first run is recorded, with the engine that was asked for.
    settings_.live.record.clear();
    settings_.live.engine.clear();
    settings_.live.is_running = true;
  }
  if (live_ != nullptr && !live_->simulation().unfinished_recording().empty()) {
    tell("recorded so far: " + live_->simulation().unfinished_recording());
  }
  pull_.reset();
  carry_.reset();
  drag_ = MouseDrag::kNone;
  source_ = std::move(source);
  live_ = live;
  chosen_ = 0;
  view_.camera = source_->drawn_scene().camera;
  title_ = name;
  const bool is_file = live != nullptr && scenes::find_catalog_scene(name) == nullptr;
  watch_ = is_file ? FileWatch(name) : FileWatch();
}

void Session::open(std::size_t row) {
  row_ = std::min(row, list_.size() - 1);
  try {
    show(list_[row_]);
    view_.shows_list = false;
  } catch (const std::exception& error) {
    tell(error.what());
  }
}

void Session::tell(std::string message) {
  message_ = std::move(message);
  message_age_ = 0.0;
}

bool Session::perform_list(Action action) {
  switch (action) {
    case Action::kListUp:
      row_ = (row_ + list_.size() - 1) % list_.size();
      view_.shows_list = true;
      return true;
    case Action::kListDown:
      row_ = (row_ + 1) % list_.size();
      view_.shows_list = true;
      return true;
    case Action::kListOpen:
      if (view_.shows_list) open(row_);
      return true;
    default:
      return false;
  }
}

bool Session::perform_parameter(Action action) {
  const bool is_choice = action == Action::kNextParameter || action == Action::kPreviousParameter;
  const bool is_change = action == Action::kLargerParameter || action == Action::kSmallerParameter;
  if (!is_choice && !is_change) return false;
  if (live_ == nullptr) {
    tell("a recording's laws cannot change, expected a scene");
    return true;
  }
  const std::vector<Parameter> parameters = parameters_of(live_->drawn_scene());
  if (parameters.empty()) return true;
  const std::size_t count = parameters.size();
  view_.shows_laws = true;
  chosen_ = std::min(chosen_, count - 1);
  if (is_choice) {
    chosen_ = (chosen_ + (action == Action::kNextParameter ? 1 : count - 1)) % count;
    return true;
  }
  const Parameter& parameter = parameters[chosen_];
  const bool grows = action == Action::kLargerParameter;
  const double sign = grows == (parameter.value >= 0.0) ? 1.0 : -1.0;
  const double value = parameter.value == 0.0 ? (grows ? kParameterStep : -kParameterStep)
                                              : parameter.value * std::pow(kParameterFactor, sign);
  live_->set_parameter(parameter, value);
  return true;
}

void Session::perform(Action action) {
  if (source_->perform(action) || perform_list(action) || perform_parameter(action)) return;
  if (action == Action::kFaster || action == Action::kSlower) {
    source_->set_speed(next_speed(source_->speed(), action == Action::kFaster ? 1 : -1));
    return;
  }
  if (action == Action::kContacts && !view_.shows_contacts) tell_of_contacts();
  if (viewer::perform(view_, action, source_->drawn_scene().camera)) return;
  tell(std::string(info_of(action).id) +
       (live_ != nullptr ? ": is for recordings" : ": is for scenes that are simulated"));
}

void Session::tell_of_contacts() {
  const SnapshotPtr shown = source_->shown();
  if (live_ == nullptr) return tell("a recording has no contacts, expected a scene");
  if (shown && !shown->touches) {
    tell(live_->engine() + ": does not tell its contacts, expected bullet_forces or bullet_weft");
  } else if (live_->engine() == "bullet_soft") {
    tell(
        "bullet_soft: contacts are Bullet's, which does not tell their forces; expected "
        "bullet_forces or bullet_weft");
  }
}

bool Session::press(const std::string& key) {
  const ActionInfo* info = find_key(key);
  if (info == nullptr) return false;
  perform(info->action);
  return true;
}

void Session::update(double seconds) {
  message_age_ += seconds;
  if (message_age_ > kMessageTime) message_.clear();
  if (live_ != nullptr && watch_.was_saved()) live_->reload();
  source_->update(seconds);
  if (std::string message = source_->take_message(); !message.empty()) tell(std::move(message));
  if (pull_ || carry_) {
    if (const SnapshotPtr shown = source_->shown())
      largest_pull_force_ = std::max(largest_pull_force_, shown->pull_force);
  }
}

void Session::begin_drag(MouseDrag drag, const Place& place, double aspect) {
  end_drag();
  last_place_ = place;
  drag_ = drag;
  if (drag != MouseDrag::kPull && drag != MouseDrag::kCarry) return;
  drag_ = MouseDrag::kNone;
  if (live_ == nullptr || !live_->simulation().can_pull()) {
    tell(live_ == nullptr ? "a recording cannot be pulled, expected a scene"
                          : live_->engine() + ": takes no forces of the mouse");
    return;
  }
  if (drag == MouseDrag::kPull) {
    begin_pull(place, aspect);
  } else {
    begin_carry(place, aspect);
  }
}

void Session::begin_carry(const Place& place, double aspect) {
  const SnapshotPtr shown = source_->shown();
  if (!shown) return;
  const scenes::Scene& scene = source_->drawn_scene();
  const scenes::Camera camera = followed(scene, view_.camera, shown->state);
  const auto seen = pick_collider(camera, aspect, place, scene, shown->state);
  if (!seen) return tell("there is no collider under the mouse that could be moved");
  grabbed_ = seen->point;
  const Vector3<double> center = shown->state.rigids[seen->collider].position;
  carry_offset_ = center - grabbed_;
  carry_ = Carry{seen->collider, center};
  live_->simulation().set_carry(carry_);
  drag_ = MouseDrag::kCarry;
}

void Session::begin_pull(const Place& place, double aspect) {
  const SnapshotPtr shown = source_->shown();
  if (!shown) return;
  const scenes::Camera camera = followed(source_->drawn_scene(), view_.camera, shown->state);
  const auto node = pick(camera, aspect, place, shown->state, shown->state.cloths.size());
  if (!node) return;
  grabbed_ = shown->state.cloths[node->cloth].positions.col(node->node);
  pull_ = Pull{*node, grabbed_};
  live_->simulation().set_pull(pull_);
  drag_ = MouseDrag::kPull;
}

void Session::drag_to(const Place& place, double aspect) {
  const double right = place.x - last_place_.x;
  const double down = place.y - last_place_.y;
  last_place_ = place;
  if (drag_ == MouseDrag::kRotate) {
    rotate(view_.camera, -kTurnOfPicture * aspect * right, kTurnOfPicture * down);
  } else if (drag_ == MouseDrag::kPan) {
    pan(view_.camera, -aspect * right, down);
  } else if (drag_ == MouseDrag::kPull && pull_ && live_ != nullptr) {
    pull_->target = dragged_to(place, aspect).value_or(pull_->target);
    live_->simulation().set_pull(pull_);
  } else if (drag_ == MouseDrag::kCarry && carry_ && live_ != nullptr) {
    const auto point = dragged_to(place, aspect);
    if (point) carry_->target = *point + carry_offset_;
    live_->simulation().set_carry(carry_);
  }
}

std::optional<Vector3<double>> Session::dragged_to(const Place& place, double aspect) {
  const SnapshotPtr shown = source_->shown();
  if (!shown) return std::nullopt;
  const scenes::Camera camera = followed(source_->drawn_scene(), view_.camera, shown->state);
  return point_at(camera, aspect, place, grabbed_);
}

void Session::end_drag() {
  if (pull_ && live_ != nullptr) live_->simulation().set_pull(std::nullopt);
  if (carry_ && live_ != nullptr) live_->simulation().set_carry(std::nullopt);
  pull_.reset();
  carry_.reset();
  drag_ = MouseDrag::kNone;
}

void Session::scroll(double notches) {
  zoom(view_.camera, std::pow(kZoomOfNotch, notches));
}

std::string Session::describe() {
  nlohmann::json json;
  source_->describe(json);
  const SnapshotPtr shown = source_->shown();
  json["title"] = title_;
  json["playing"] = source_->is_playing();
  json["speed"] = source_->speed();
  json["frame"] = source_->frame();
  json["num_frames"] = source_->num_frames();
  json["style"] = style_name(view_.style);
  const auto numbers = [](const Vector3<double>& v) { return nlohmann::json{v.x(), v.y(), v.z()}; };
  json["camera"] = {{"position", numbers(view_.camera.position)},
                    {"target", numbers(view_.camera.target)}};
  json["shadow"] = view_.has_shadow;
  json["worst_shown"] = view_.shows_worst;
  json["contacts_shown"] = view_.shows_contacts;
  json["filming"] = view_.is_filming;
  json["panels"] = view_.shows_panels;
  json["laws_shown"] = view_.shows_laws;
  json["plots"] = view_.shows_plots;
  json["help"] = view_.shows_help;
  json["list"] = view_.shows_list;
  json["row"] = row_;
  json["chosen"] = chosen_;
  json["full_screen"] = view_.is_full_screen;
  json["text_scale"] = view_.text_scale;
  json["window"] = {view_.size.width, view_.size.height};
  json["largest_pull_N"] = largest_pull_force_;
  json["message"] = message_;
  if (shown) {
    json["time"] = shown->state.time;
    json["step"] = shown->step;
    json["parts"] = shown->num_parts;
    json["kinetic_energy"] = shown->measures.kinetic_energy;
    json["largest_strain"] = shown->measures.largest_strain;
    nlohmann::json& rigids = json["rigids"] = nlohmann::json::object();
    for (const scenes::RigidState& rigid : shown->state.rigids) {
      rigids[rigid.name] = numbers(rigid.position);
    }
    if (shown->touches) {
      const auto sticks = [](const scenes::NodeTouch& touch) { return touch.is_sticking; };
      json["touches"] = shown->touches->size();
      json["sticking"] = std::count_if(shown->touches->begin(), shown->touches->end(), sticks);
    }
    if (shown->measures.worst) json["worst_node"] = shown->measures.worst->id.node;
    if (shown->blow_up) json["blow_up"] = shown->blow_up->reason;
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace weft::viewer
