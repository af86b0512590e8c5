// Tested by tests/apps/CMakeLists.txt.

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/validation/cases/scenes/scene_section.hpp>
#include <weft/validation/metrics/distance/vertex_distance.hpp>

namespace weft::validation {
namespace {

constexpr int kWidth =
    640;  // [pixels]; five pictures side by side on a wide screen, sharp on a phone
constexpr int kHeight = 300;  // [pixels]

scenes::RenderOptions options_for(scenes::SurfaceStyle style) {
  scenes::RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.style = style;
  return options;
}

Picture draw(scenes::Renderer& renderer, const History& history, const scenes::SceneState& frame,
             scenes::SurfaceStyle style, const scenes::ScalarField* field = nullptr) {
  Picture picture;
  picture.title = history.engine.title();
  picture.caption = fmt::format("t = {:.2f} s", frame.time);
  picture.image = scenes::encode_jpeg(renderer.render(frame, options_for(style), field));
  return picture;
}

/// The frame of all frames in which the cloth moves most: where folds and engines differ in
/// mid-flight.
std::size_t middle_frame(const Frames& frames) {
  return frames.size() / 3;
}

scenes::ScalarField strain_field(const SceneMetrics& metrics, const scenes::SceneState& frame,
                                 double largest) {
  scenes::ScalarField field;
  field.label = "strain [%]";
  field.minimum = -largest;
  field.maximum = largest;
  for (std::size_t c = 0; c < frame.cloths.size(); ++c) {
    field.values.push_back(100 *
                           scenes::node_strain(metrics.meshes()[c], frame.cloths[c].positions));
  }
  return field;
}

double largest_strain(const SceneMetrics& metrics, const scenes::SceneState& frame) {
  double largest = 0;
  for (const Eigen::VectorXd& values : strain_field(metrics, frame, 1).values) {
    largest = std::max(largest, values.cwiseAbs().maxCoeff());
  }
  return largest;
}

scenes::ScalarField distance_field(const scenes::SceneState& frame,
                                   const scenes::SceneState& reference) {
  scenes::ScalarField field;
  field.minimum = 0;
  double largest = 0;
  for (std::size_t c = 0; c < frame.cloths.size(); ++c) {
    field.values.push_back(
        node_distances(frame.cloths[c].positions, reference.cloths[c].positions));
    largest = std::max(largest, field.values.back().maxCoeff());
  }
  // In a unit in which the scale reads well.
  const bool tiny = largest < 1e-6;
  const double scale = tiny ? 1e9 : 1e3;
  for (Eigen::VectorXd& values : field.values) values *= scale;
  field.maximum = largest > 0 ? largest * scale : 1.0;
  field.label = tiny ? "distance to the reference [nm]" : "distance to the reference [mm]";
  return field;
}

/// Both precisions look the same; one of them keeps the page of all cases within 6 MB.
bool is_shown(const EngineChoice& engine) {
  const bool is_alone = engine.engine == "reference" || engine.engine == kRecordingEngine;
  return is_alone || engine.precision == scenes::StoredPrecision::kFloat32;
}

}  // namespace

std::vector<PictureRow> scene_pictures(const SceneMetrics& metrics,
                                       const std::vector<History>& histories, bool has_view) {
  using scenes::SurfaceStyle;
  scenes::Renderer renderer(metrics.scene());
  PictureRow moving{"On the way", {}};
  PictureRow shaded{"At the end", {}};
  PictureRow wireframe{"Wireframe", {}};
  PictureRow strain{"Strain", {}};
  PictureRow difference{"Difference to the reference, on the engine's cloth", {}};
  const Frames& reference = histories.back().frames;
  const double strain_scale = reference.empty() ? 1.0 : largest_strain(metrics, reference.back());
  for (const History& history : histories) {
    if (history.frames.empty() || !is_shown(history.engine)) continue;
    const Frames& frames = history.frames;
    moving.pictures.push_back(
        draw(renderer, history, frames[middle_frame(frames)], SurfaceStyle::kShaded));
    shaded.pictures.push_back(draw(renderer, history, frames.back(), SurfaceStyle::kShaded));
    const scenes::ScalarField strains = strain_field(metrics, frames.back(), strain_scale);
    strain.pictures.push_back(
        draw(renderer, history, frames.back(), SurfaceStyle::kScalar, &strains));
    const bool is_reference = &history == &histories.back();
    if (is_reference) {
      wireframe.pictures.push_back(
          draw(renderer, history, frames.back(), SurfaceStyle::kWireframe));
    }
    if (!has_view && !is_reference && frames.size() == reference.size()) {
      const scenes::ScalarField field = distance_field(frames.back(), reference.back());
      difference.pictures.push_back(
          draw(renderer, history, frames.back(), SurfaceStyle::kScalar, &field));
    }
  }
  std::vector<PictureRow> rows;
  for (PictureRow* row : {&moving, &shaded, &difference, &strain, &wireframe}) {
    if (!row->pictures.empty()) rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace weft::validation
