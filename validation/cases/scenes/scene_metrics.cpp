#include <weft/validation/cases/scenes/scene_metrics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <weft/validation/metrics/distance/penetration.hpp>
#include <weft/validation/metrics/distance/surface_distance.hpp>
#include <weft/validation/metrics/distance/vertex_distance.hpp>
#include <weft/validation/metrics/strain.hpp>

namespace weft::validation {
namespace {

/// Maximum that does not swallow a NaN.
double larger_metric(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

}  // namespace

bool is_shape_number(Quantity quantity) {
  return quantity == Quantity::kMeanHeight || quantity == Quantity::kMeanRadius;
}

const char* unit_of(Quantity quantity) {
  return quantity == Quantity::kRmsDistance || is_shape_number(quantity) ? "1" : "m";
}

SceneMetrics::SceneMetrics(const scenes::Scene& scene) : scene_(scene), energy_(scene) {
  for (const scenes::Cloth& cloth : scene.cloths) {
    meshes_.push_back(scenes::make_mesh(cloth));
    weights_.push_back(node_weights(meshes_.back()));
    cloth_size_ = std::max(cloth_size_, scenes::body_size(cloth.source));
  }
}

double SceneMetrics::at(Quantity quantity, const scenes::SceneState& state,
                        const scenes::SceneState& reference) const {
  double value = 0.0;
  if (quantity == Quantity::kDepth) {
    for (const Penetration& penetration : penetrations(scene_, state)) {
      value = larger_metric(value, penetration.surface.deepest);
    }
    return value;
  }
  if (quantity == Quantity::kRigidDistance) {
    for (std::size_t r = 0; r < state.rigids.size(); ++r) {
      value =
          larger_metric(value, (state.rigids[r].position - reference.rigids[r].position).norm());
    }
    return value;
  }
  if (is_shape_number(quantity)) {
    return std::abs(shape_number(quantity, state) - shape_number(quantity, reference));
  }
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    const VertexDistance distance =
        vertex_distance(state.cloths[c].positions, reference.cloths[c].positions, weights_[c]);
    value = larger_metric(value, quantity == Quantity::kLargestDistance
                                     ? distance.largest
                                     : distance.rms_relative_to(cloth_size_));
  }
  return value;
}

double SceneMetrics::shape_number(Quantity quantity, const scenes::SceneState& state) const {
  double sum = 0.0, count = 0.0;
  for (const scenes::ClothState& cloth : state.cloths) {
    const Matrix3X<double>& nodes = cloth.positions;
    const Vector3<double> middle = nodes.rowwise().mean();
    sum += quantity == Quantity::kMeanHeight
               ? nodes.row(1).sum()
               : (nodes.row(0).array() - middle.x()).square().sum() +
                     (nodes.row(2).array() - middle.z()).square().sum();
    count += static_cast<double>(nodes.cols());
  }
  const double mean = sum / count;
  return (quantity == Quantity::kMeanHeight ? mean : std::sqrt(mean)) / cloth_size_;
}

double SceneMetrics::mean_shape_number(Quantity quantity, const Frames& frames, double begin,
                                       double end) const {
  const double slack = 0.01 * scene_.world.time_step;
  double sum = 0.0, count = 0.0;
  for (const scenes::SceneState& frame : frames) {
    if (frame.time < begin - slack || frame.time > end + slack) continue;
    sum += shape_number(quantity, frame);
    count += 1.0;
  }
  const bool covers =
      !frames.empty() && frames.back().time + scene_.world.frame_interval > end - slack;
  return covers && count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

double SceneMetrics::largest(Quantity quantity, const Frames& frames, const Frames& reference,
                             double begin, double end) const {
  // A frame belongs to the interval if it is nearer to it than a hundredth of a step: frame times
  // are sums.
  const double slack = 0.01 * scene_.world.time_step;
  double value = 0.0;
  double covered_until = -1.0;
  for (std::size_t f = 0; f < std::min(frames.size(), reference.size()); ++f) {
    covered_until = frames[f].time;
    if (frames[f].time < begin - slack || frames[f].time > end + slack) continue;
    value = larger_metric(value, at(quantity, frames[f], reference[f]));
  }
  const bool covers = covered_until + scene_.world.frame_interval > end - slack;
  return covers ? value : std::numeric_limits<double>::infinity();
}

SceneMetrics::SurfaceGap SceneMetrics::surface_gap(const scenes::SceneState& state,
                                                   const scenes::SceneState& reference) const {
  SurfaceGap result{0, 0};
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    const SurfaceDistance distance =
        surface_distance(Surface{state.cloths[c].positions, meshes_[c].triangles},
                         Surface{reference.cloths[c].positions, meshes_[c].triangles});
    result.percentile_95 = larger_metric(result.percentile_95, distance.hausdorff_95 / cloth_size_);
    result.largest = larger_metric(result.largest, distance.hausdorff / cloth_size_);
  }
  return result;
}

double SceneMetrics::aligned_rms(const scenes::SceneState& state,
                                 const scenes::SceneState& reference) const {
  double value = 0.0;
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    value = larger_metric(value, aligned_vertex_distance(state.cloths[c].positions,
                                                         reference.cloths[c].positions, weights_[c])
                                     .rms_relative_to(cloth_size_));
  }
  return value;
}

VectorX<double> SceneMetrics::stretch_strains(const scenes::SceneState& state) const {
  VectorX<double> all(0);
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    const Edges edges = meshes_[c].edges_of({"stretch"});
    const VectorX<double> strains = edge_strains(state.cloths[c].positions, edges,
                                                 edge_lengths(meshes_[c].rest_positions, edges));
    const Eigen::Index old = all.size();
    all.conservativeResize(old + strains.size());
    all.tail(strains.size()) = strains;
  }
  return all;
}

}  // namespace weft::validation
