#include <weft/viewer/recorded/recorded_source.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

#include <nlohmann/json.hpp>

namespace weft::viewer {
namespace {

/// Wall time for the plots between two pictures [s].
constexpr double kMeasureTime = 0.004;
/// Between two looks at a recording that may grow [s]; it is opened anew, which takes at most a fifth of the time.
constexpr double kLookInterval = 0.25;
constexpr double kIdleShare = 4.0;

}  // namespace

RecordedSource::RecordedSource(const std::vector<std::filesystem::path>& paths)
    : comparison_(paths), time_(comparison_.frame_time(0)) {
  if (!comparison_.reader().finished()) {
    message_ = comparison_.path().string() + ": is partial; new frames are shown as they come";
  }
}

const scenes::Scene& RecordedSource::drawn_scene() const {
  return comparison_.drawn_scene();
}

std::optional<scenes::Ghosts> RecordedSource::ghosts() const {
  if (!comparison_.has_ghosts()) return std::nullopt;
  return comparison_.ghosts();
}

std::vector<ShownRecording> RecordedSource::recordings() const {
  std::vector<ShownRecording> list = {{comparison_.path().filename().string()}};
  for (std::size_t r = 0; comparison_.has_ghosts() && r < comparison_.size(); ++r) {
    if (r == comparison_.solid()) continue;
    list.push_back({comparison_.path(r).filename().string(), Comparison::ghost_color(r)});
  }
  return list;
}

double RecordedSource::frame_time(int frame) const {
  return comparison_.frame_time(frame);
}

// Who stands at the last frame, or has played up to it, goes on with the new ones.
void RecordedSource::follow(double seconds) {
  look_age_ += seconds;
  if (!comparison_.may_grow() || look_age_ < look_interval_) return;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const bool is_last = frame_ == num_frames() - 1;
  if (comparison_.follow() && is_last && !is_playing_) seek(num_frames() - 1);
  if (!comparison_.may_grow()) {
    message_ = comparison_.path().string() +
               (comparison_.reader().finished() ? ": is whole now" : ": does not grow any more");
  }
  const double taken = std::chrono::duration<double>(Clock::now() - start).count();
  look_interval_ = std::max(kLookInterval, kIdleShare * taken);
  look_age_ = 0.0;
}

void RecordedSource::update(double seconds) {
  follow(seconds);
  (void)comparison_.measure_more(kMeasureTime);
  if (!is_playing_) return;
  const double end = frame_time(num_frames() - 1);
  time_ += speed_ * seconds;
  if (time_ > end) {
    const bool may_grow = comparison_.may_grow();
    if (is_looping_ && num_frames() > 1 && !may_grow) {
      time_ = frame_time(0);
    } else {
      time_ = end;
      is_playing_ = may_grow;
    }
  }
  frame_ = comparison_.frame_at(time_);
}

void RecordedSource::seek(int frame) {
  frame_ = std::clamp(frame, 0, num_frames() - 1);
  time_ = frame_time(frame_);
}

void RecordedSource::rebuilt() {
  ++version_;
  frame_ = comparison_.frame_at(time_);
}

bool RecordedSource::perform(Action action) {
  switch (action) {
    case Action::kPause:
      is_playing_ = !is_playing_;
      if (is_playing_ && frame_ == num_frames() - 1) seek(0);
      return true;
    case Action::kRestart:
      seek(0);
      is_playing_ = true;
      return true;
    case Action::kStepForward:
    case Action::kStepBack:
      is_playing_ = false;
      seek(frame_ + (action == Action::kStepForward ? 1 : -1));
      return true;
    case Action::kFirstFrame:
      seek(0);
      return true;
    case Action::kLastFrame:
      seek(num_frames() - 1);
      return true;
    case Action::kLoop:
      is_looping_ = !is_looping_;
      message_ = is_looping_ ? "starts again at the end" : "stops at the end";
      return true;
    case Action::kGhosts:
      comparison_.show_ghosts(!comparison_.has_ghosts());
      rebuilt();
      if (comparison_.size() < 2) message_ = "ghosts: there is one recording, expected several";
      return true;
    case Action::kNextGhost:
      comparison_.next();
      rebuilt();
      message_ = "solid: " + comparison_.path().filename().string();
      return true;
    default:
      return false;
  }
}

std::string RecordedSource::take_message() {
  return std::exchange(message_, {});
}

std::vector<PlotPoint> RecordedSource::plot() const {
  std::vector<PlotPoint> points;
  const auto& measures = comparison_.measures();
  for (std::size_t f = 0; f < measures.size(); ++f) {
    if (measures[f]) points.push_back({frame_time(static_cast<int>(f)), *measures[f], 0.0});
  }
  return points;
}

void RecordedSource::describe(nlohmann::json& json) const {
  json["kind"] = "recording";
  json["recordings"] = comparison_.size();
  json["solid"] = comparison_.path().filename().string();
  json["ghosts"] = comparison_.has_ghosts();
  json["drawn_cloths"] = drawn_scene().cloths.size();
  json["loop"] = is_looping_;
  json["may_grow"] = comparison_.may_grow();
  json["notes"] = comparison_.notes().size();
}

}  // namespace weft::viewer
