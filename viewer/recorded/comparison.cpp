#include <weft/viewer/recorded/comparison.hpp>

#include <array>
#include <chrono>
#include <system_error>
#include <utility>

#include <weft/core/error.hpp>

namespace weft::viewer {
namespace {

/// Colors of ghosts, one for each recording: far from one another, also for the color-blind.
constexpr std::array<scenes::Rgb, 4> kGhostColors = {
    {{230, 120, 20}, {20, 150, 90}, {190, 60, 160}, {120, 100, 40}}};

/// Half: of the four samples of a pixel two are drawn, and no pattern is seen.
constexpr double kGhostOpacity = 0.5;

bool may_move(const scenes::Collider& collider) {
  return collider.mass || collider.path || !collider.led_by.empty();
}

void make_ghost(scenes::Appearance& appearance, const scenes::Rgb& color) {
  const bool is_visible = appearance.visible;
  appearance = {};
  appearance.visible = is_visible;
  appearance.color = color;
  appearance.back_color = color;
}

/// The name that a partial recording gets when its run has ended: without ".partial" or ".partial-2".
std::filesystem::path whole_name(const std::filesystem::path& partial) {
  const std::filesystem::path stem = partial.stem();  // x.partial
  const std::string kind = stem.extension().string();
  if (kind != ".partial" && !kind.starts_with(".partial-")) return partial;
  return partial.parent_path() / (stem.stem().string() + partial.extension().string());
}

int last_not_after(const scenes::RecordingReader& reader, double time) {
  // Times of two engines may differ by a rounding.
  const double limit = time + 1e-9;
  int low = 0;
  int high = reader.num_frames() - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (reader.frame_time(middle) <= limit) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

}  // namespace

Comparison::Comparison(std::vector<std::filesystem::path> paths) : paths_(std::move(paths)) {
  are_gone_.assign(paths_.size(), 0);
  for (const std::filesystem::path& path : paths_) {
    stamps_.push_back(stamp_of(path));
    readers_.push_back(std::make_unique<scenes::RecordingReader>(path));
    if (readers_.back()->num_frames() == 0) {
      throw Error(path.string() + ": has no frame, expected a recording with at least one");
    }
    std::vector<std::size_t>& moving = moving_.emplace_back();
    const auto& colliders = readers_.back()->scene().colliders;
    for (std::size_t k = 0; k < colliders.size(); ++k) {
      if (may_move(colliders[k])) moving.push_back(k);
    }
  }
  rebuild();
}

Comparison::Stamp Comparison::stamp_of(const std::filesystem::path& path) {
  Stamp stamp;
  const std::filesystem::path files[] = {path, path.string() + "-wal"};
  for (std::size_t i = 0; i < 2; ++i) {
    std::error_code none;  // no log: nothing to compare
    stamp.times[i] = std::filesystem::last_write_time(files[i], none);
    if (none) stamp.times[i] = {};
    stamp.sizes[i] = std::filesystem::file_size(files[i], none);
    if (none) stamp.sizes[i] = 0;
  }
  return stamp;
}

bool Comparison::may_grow() const {
  for (std::size_t r = 0; r < readers_.size(); ++r) {
    if (!readers_[r]->finished() && !readers_[r]->blow_up() && are_gone_[r] == 0) return true;
  }
  return false;
}

bool Comparison::follow() {
  bool has_grown = false;
  for (std::size_t r = 0; r < readers_.size(); ++r) {
    if (!readers_[r]->finished() && are_gone_[r] == 0) has_grown = follow(r) || has_grown;
  }
  if (!has_grown) return false;
  measures_.resize(static_cast<std::size_t>(num_frames()));
  notes_ = reader().notes();
  last_frame_ = -1;
  return true;
}

bool Comparison::follow(std::size_t recording) {
  std::filesystem::path path = paths_[recording];
  std::error_code none;
  if (!std::filesystem::exists(path, none)) {
    path = whole_name(path);
    if (path == paths_[recording] || !std::filesystem::exists(path, none)) {
      are_gone_[recording] = 1;
      return false;
    }
  }
  const Stamp stamp = stamp_of(path);
  if (path == paths_[recording] && stamp == stamps_[recording]) return false;
  try {
    auto reader = std::make_unique<scenes::RecordingReader>(path);
    const scenes::RecordingReader& old = *readers_[recording];
    const bool is_the_same =
        reader->scene_text() == old.scene_text() && reader->num_frames() >= old.num_frames();
    if (!is_the_same) {
      are_gone_[recording] = 1;
      return false;
    }
    stamps_[recording] = stamp;
    const bool has_more = reader->num_frames() > old.num_frames() || reader->finished();
    paths_[recording] = path;
    readers_[recording] = std::move(reader);
    return has_more;
  } catch (const Error&) {
    return false;  // in the middle of a change: the next look reads it whole
  }
}

scenes::Rgb Comparison::ghost_color(std::size_t recording) {
  return kGhostColors[recording % kGhostColors.size()];
}

void Comparison::next() {
  solid_ = (solid_ + 1) % readers_.size();
  rebuild();
}

void Comparison::show_ghosts(bool are_shown) {
  are_shown_ = are_shown;
  rebuild();
}

void Comparison::rebuild() {
  drawn_scene_ = reader().scene();
  for (std::size_t r = 0; has_ghosts() && r < readers_.size(); ++r) {
    if (r == solid_) continue;
    const scenes::Rgb color = ghost_color(r);
    const scenes::Scene& scene = readers_[r]->scene();
    for (scenes::Cloth cloth : scene.cloths) {
      make_ghost(cloth.appearance, color);
      drawn_scene_.cloths.push_back(std::move(cloth));
    }
    for (const std::size_t k : moving_[r]) {
      scenes::Collider collider = scene.colliders[k];
      make_ghost(collider.appearance, color);
      drawn_scene_.colliders.push_back(std::move(collider));
    }
  }
  meter_ = std::make_unique<Meter>(reader().scene());
  measures_.assign(static_cast<std::size_t>(num_frames()), std::nullopt);
  num_measured_ = 0;
  notes_ = reader().notes();
  last_frame_ = -1;
}

scenes::Ghosts Comparison::ghosts() const {
  return {reader().scene().cloths.size(), reader().scene().colliders.size(), kGhostOpacity};
}

int Comparison::frame_at(double time) const {
  return last_not_after(reader(), time);
}

SnapshotPtr Comparison::frame(int frame) {
  if (frame == last_frame_) return last_;
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->state = reader().frame(frame);
  snapshot->state.time = frame_time(frame);
  std::optional<Measures>& measures = measures_.at(static_cast<std::size_t>(frame));
  if (!measures) measures = meter_->measure(snapshot->state);
  snapshot->measures = *measures;
  snapshot->step = frame;
  snapshot->marks = reader().marks(frame);
  const auto blow_up = reader().blow_up();
  if (blow_up && blow_up->time <= snapshot->state.time) snapshot->blow_up = blow_up;
  for (std::size_t r = 0; has_ghosts() && r < readers_.size(); ++r) {
    if (r == solid_) continue;
    scenes::SceneState other =
        readers_[r]->frame(last_not_after(*readers_[r], snapshot->state.time));
    for (scenes::ClothState& cloth : other.cloths)
      snapshot->state.cloths.push_back(std::move(cloth));
    for (const std::size_t k : moving_[r]) snapshot->state.rigids.push_back(other.rigids[k]);
  }
  last_ = snapshot;
  last_frame_ = frame;
  return last_;
}

bool Comparison::measure_more(double seconds) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  while (num_measured_ < measures_.size() &&
         std::chrono::duration<double>(Clock::now() - start).count() < seconds) {
    std::optional<Measures>& measures = measures_[num_measured_];
    if (!measures) measures = meter_->measure(reader().frame(static_cast<int>(num_measured_)));
    ++num_measured_;
  }
  return num_measured_ == measures_.size();
}

}  // namespace weft::viewer
