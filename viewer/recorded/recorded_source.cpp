#include <weft/viewer/recorded/recorded_source.hpp>

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

namespace weft::viewer {
namespace {

/// Wall time for the plots between two pictures [s].
constexpr double kMeasureTime = 0.004;

}  // namespace

RecordedSource::RecordedSource(const std::vector<std::filesystem::path>& paths)
    : comparison_(paths), time_(comparison_.frame_time(0)) {
  if (!comparison_.reader().finished()) {
    message_ = comparison_.path().string() + ": is partial; it is shown as far as it goes";
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

void RecordedSource::update(double seconds) {
  (void)comparison_.measure_more(kMeasureTime);
  if (!is_playing_) return;
  const double end = frame_time(num_frames() - 1);
  time_ += speed_ * seconds;
  if (time_ > end) {
    if (is_looping_ && num_frames() > 1) {
      time_ = frame_time(0);
    } else {
      time_ = end;
      is_playing_ = false;
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
}

}  // namespace weft::viewer
