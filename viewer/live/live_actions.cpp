// Tested by tests/viewer/session_test.cpp.

#include <algorithm>

#include <fmt/format.h>

#include <weft/viewer/live/live_source.hpp>
#include <weft/viewer/model/cloth_type.hpp>

namespace weft::viewer {
namespace {

/// The step of the keys: 0.5 m/s of wind, 1 m/s^2 of gravity.
constexpr double kWindStep = 0.5;
constexpr double kGravityStep = 1.0;

std::string vector_text(const Vector3<double>& v, const char* unit) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) {}", v.x(), v.y(), v.z(), unit);
}

}  // namespace

void LiveSource::step(int direction) {
  if (direction > 0 && !looked_back_ && !is_playing_) {
    simulation_->step_once();
    return;
  }
  seek(frame() + direction);
}

bool LiveSource::perform_time(Action action) {
  switch (action) {
    case Action::kPause:
      is_playing_ = !is_playing_;
      looked_back_ = nullptr;
      simulation_->set_running(is_playing_);
      return true;
    case Action::kRestart:
      start(true);
      return true;
    case Action::kRestartAsWritten:
      scene_ = written_;
      has_other_laws_ = false;
      cloth_type_ = 0;
      start(true);
      message_ = "laws as written";
      return true;
    case Action::kStepForward:
    case Action::kStepBack:
      step(action == Action::kStepForward ? 1 : -1);
      return true;
    case Action::kTakeBack:
      looked_back_ = nullptr;
      if (is_playing_) {
        message_ = "take back: the run goes on, expected a paused one";
      } else {
        simulation_->take_back();
      }
      return true;
    case Action::kFirstFrame:
      seek(0);
      return true;
    case Action::kLastFrame:
      looked_back_ = nullptr;
      return true;
    default:
      return false;
  }
}

bool LiveSource::perform_wind_or_gravity(Action action) {
  const int wind = static_cast<int>(action) - static_cast<int>(Action::kWindXMore);
  const int gravity = static_cast<int>(action) - static_cast<int>(Action::kGravityXMore);
  const auto change = [](int row, double step) {
    Vector3<double> v(0, 0, 0);
    v[row / 2] = row % 2 == 0 ? step : -step;
    return v;
  };
  if (wind >= 0 && wind < 6) {
    const int num_cloths = add_wind(scene_, change(wind, kWindStep));
    message_ = num_cloths > 0 ? "wind " + vector_text(wind_of(scene_), "m/s")
                              : "wind: no cloth of the scene has triangles that could feel it";
    send_laws();
    return true;
  }
  if (gravity >= 0 && gravity < 6) {
    add_gravity(scene_, change(gravity, kGravityStep));
    message_ = "gravity " + vector_text(gravity_of(scene_), "m/s^2");
    simulation_->set_gravity(scene_.world.gravity);
    send_laws();
    return true;
  }
  return false;
}

bool LiveSource::perform(Action action) {
  if (perform_time(action) || perform_wind_or_gravity(action)) return true;
  const std::size_t num_types = cloth_types().size();
  switch (action) {
    case Action::kNextCloth:
      set_cloth_type((cloth_type_ + 1) % num_types);
      return true;
    case Action::kPreviousCloth:
      set_cloth_type((cloth_type_ + num_types - 1) % num_types);
      return true;
    case Action::kReload:
      reload();
      return true;
    case Action::kNextEngine: {
      const std::vector<std::string> names = engines();
      const auto now = std::find(names.begin(), names.end(), settings_.engine);
      set_engine(now == names.end() || now + 1 == names.end() ? names.front() : *(now + 1));
      return true;
    }
    default:
      return false;
  }
}

}  // namespace weft::viewer
