#include "apps/film/film.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/montage.hpp>
#include <weft/scenes/recording/frame_times.hpp>
#include <weft/scenes/torn_cloth.hpp>

namespace weft::app {
namespace {

constexpr const char* kDifference = "difference";

std::vector<Eigen::VectorXd> strains_percent(const scenes::Scene& scene,
                                             const scenes::SceneState& state) {
  std::vector<Eigen::VectorXd> values;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const scenes::ClothState& cloth = state.cloths[c];
    const ClothMesh mesh =
        scenes::drawn_mesh(scenes::make_mesh(scene.cloths[c]), cloth.topology.get());
    values.push_back(100 * scenes::node_strain(mesh, cloth.positions));
  }
  return values;
}

double largest_of(const std::vector<Eigen::VectorXd>& values) {
  double largest = 0.0;
  for (const Eigen::VectorXd& of_cloth : values) {
    if (of_cloth.size() > 0) largest = std::max(largest, of_cloth.cwiseAbs().maxCoeff());
  }
  return largest;
}

/// One scale for all frames: that of the last one, where most scenes carry their full load.
scenes::ScalarField strain_scale(const scenes::RecordingReader& reader) {
  scenes::ScalarField field;
  field.label = "strain [%]";
  const double largest =
      largest_of(strains_percent(reader.scene(), reader.frame(reader.num_frames() - 1)));
  field.maximum = largest > 0 && std::isfinite(largest) ? largest : 1.0;
  field.minimum = -field.maximum;
  return field;
}

std::string file_name(const NamedRecording& recording) {
  return std::filesystem::path(recording.file).filename().string();
}

void name_picture(scenes::Image& picture, const std::string& name, double time) {
  scenes::draw_label(picture, fmt::format("{}, t = {:.4g} s", name, time));
}

}  // namespace

int nearest_frame(const scenes::RecordingReader& reader, double time) {
  int best = 0;
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const double distance = std::abs(reader.frame_time(frame) - time);
    if (distance < std::abs(reader.frame_time(best) - time)) best = frame;
  }
  return best;
}

Film::Film(const scenes::RecordingReader& reader, const scenes::RenderOptions& options)
    : reader_(reader), options_(options), renderer_(reader.scene()) {}

scenes::Image Film::draw(int frame, const std::string& style) {
  const scenes::SceneState state = reader_.frame(frame);
  options_.marks = reader_.marks(frame);
  if (style != "strain") {
    options_.style =
        style == "wireframe" ? scenes::SurfaceStyle::kWireframe : scenes::SurfaceStyle::kShaded;
    return renderer_.render(state, options_);
  }
  if (!strain_) strain_ = strain_scale(reader_);
  strain_->values = strains_percent(reader_.scene(), state);
  return draw(frame, *strain_);
}

scenes::Image Film::draw(int frame, const scenes::ScalarField& field) {
  options_.style = scenes::SurfaceStyle::kScalar;
  options_.marks = reader_.marks(frame);
  return renderer_.render(reader_.frame(frame), options_, &field);
}

Shots::Shots(NamedRecording first, std::optional<NamedRecording> second,
             std::vector<std::string> styles, const scenes::RenderOptions& options)
    : first_(std::move(first)),
      second_(std::move(second)),
      styles_(std::move(styles)),
      first_film_(first_.reader, options) {
  if (second_) second_film_.emplace(second_->reader, options);
  frames_.resize(static_cast<std::size_t>(first_.reader.num_frames()));
  std::iota(frames_.begin(), frames_.end(), 0);
  if (!has_difference()) return;
  if (!second_) {
    throw InvalidArgument("--style difference: expected a second recording (--beside)");
  }
  find_common_frames();
}

bool Shots::has_difference() const {
  return std::find(styles_.begin(), styles_.end(), kDifference) != styles_.end();
}

void Shots::find_common_frames() {
  frames_.clear();
  for (const auto& [a, b] : scenes::common_frames(first_.reader, second_->reader)) {
    frames_.push_back(a);
    partners_.push_back(b);
  }
  if (frames_.empty()) {
    throw Error(
        fmt::format("{}: has no frame of a time that {} has, expected one for the difference",
                    second_->file, first_.file));
  }
  double largest = 0.0;
  for (const int frame : frames_) largest = std::max(largest, largest_of(distances(frame)));
  difference_.label = "distance [mm]";
  difference_.maximum = largest > 0 && std::isfinite(largest) ? largest : 1.0;
}

int Shots::partner(int frame) const {
  const auto found = std::lower_bound(frames_.begin(), frames_.end(), frame);
  return partners_[static_cast<std::size_t>(found - frames_.begin())];
}

std::vector<Eigen::VectorXd> Shots::distances(int frame) const {
  const scenes::SceneState a = first_.reader.frame(frame);
  const scenes::SceneState b = second_->reader.frame(partner(frame));
  std::vector<Eigen::VectorXd> values;
  for (const scenes::ClothState& cloth : a.cloths) {
    const auto other = std::find_if(b.cloths.begin(), b.cloths.end(), [&](const auto& candidate) {
      return candidate.name == cloth.name;
    });
    const Eigen::Index expected = cloth.positions.cols();
    const Eigen::Index found = other == b.cloths.end() ? 0 : other->positions.cols();
    if (found != expected) {
      throw Error(fmt::format("{}: cloth '{}' has {} nodes at t = {:.6g} s, expected {} as in {}",
                              second_->file, cloth.name, found, b.time, expected, first_.file));
    }
    values.emplace_back(1e3 * (other->positions - cloth.positions).colwise().norm().transpose());
  }
  return values;
}

int Shots::num_pictures() const {
  int count = 0;
  for (const std::string& style : styles_) count += second_ && style != kDifference ? 2 : 1;
  return count;
}

void Shots::set_camera(const scenes::Camera& camera) {
  first_film_.set_camera(camera);
  if (second_film_) second_film_->set_camera(camera);
}

std::vector<scenes::Image> Shots::draw(int frame) {
  const double time = first_.reader.frame_time(frame);
  std::vector<scenes::Image> pictures;
  for (const std::string& style : styles_) {
    if (style == kDifference) {
      difference_.values = distances(frame);
      pictures.push_back(first_film_.draw(frame, difference_));
      name_picture(pictures.back(), "distance to " + file_name(*second_), time);
      continue;
    }
    pictures.push_back(first_film_.draw(frame, style));
    if (!second_) continue;
    name_picture(pictures.back(), file_name(first_), time);
    const int other = nearest_frame(second_->reader, time);
    pictures.push_back(second_film_->draw(other, style));
    name_picture(pictures.back(), file_name(*second_), second_->reader.frame_time(other));
  }
  return pictures;
}

}  // namespace weft::app
