// Tested by tests/apps/CMakeLists.txt.

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include <weft/validation/cases/scenes/scene_section.hpp>
#include <weft/validation/cases/support/decimated_mesh.hpp>
#include <weft/validation/metrics/distance/vertex_distance.hpp>

namespace weft::validation {
namespace {

constexpr std::size_t kMaxFrames = 12;
constexpr int kMaxNodes = 1500;  // of all cloths: with the frames about 0.3 MB per scene

/// First and last frame and others evenly between them.
std::vector<std::size_t> chosen_frames(std::size_t num_frames) {
  std::vector<std::size_t> frames;
  const std::size_t count = std::min(num_frames, kMaxFrames);
  for (std::size_t i = 0; i < count; ++i) {
    frames.push_back(count > 1 ? (i * (num_frames - 1) + (count - 1) / 2) / (count - 1) : 0);
  }
  return frames;
}

std::vector<DecimatedMesh> decimated_cloths(const SceneMetrics& metrics) {
  int total = 0;
  for (const ClothMesh& mesh : metrics.meshes()) total += mesh.num_nodes();
  std::vector<DecimatedMesh> decimated;
  for (const ClothMesh& mesh : metrics.meshes()) {
    const int share =
        total > kMaxNodes ? std::max(1, kMaxNodes * mesh.num_nodes() / total) : mesh.num_nodes();
    decimated.push_back(decimate(mesh.rest_positions, mesh.triangles, share));
  }
  return decimated;
}

std::vector<double> drawn_coordinates(const scenes::SceneState& state,
                                      const std::vector<DecimatedMesh>& cloths) {
  std::vector<double> values;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    for (const int node : cloths[c].nodes) {
      const Vector3<double> position = state.cloths[c].positions.col(node);
      values.insert(values.end(), {position.x(), position.y(), position.z()});
    }
  }
  return values;
}

/// A run without this frame has no distance there.
void add_missing_frame(DistanceViewEngine& engine) {
  engine.largest.push_back(std::numeric_limits<double>::quiet_NaN());
  engine.distances.emplace_back();
}

void add_frame(DistanceViewEngine& engine, const scenes::SceneState& state,
               const scenes::SceneState& reference, const std::vector<DecimatedMesh>& cloths) {
  std::vector<double> drawn;
  double largest = 0.0;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const VectorX<double> distances =
        node_distances(state.cloths[c].positions, reference.cloths[c].positions);
    for (const double distance : distances) {
      if (std::isfinite(distance)) largest = std::max(largest, distance);
    }
    for (const int node : cloths[c].nodes) drawn.push_back(distances[node]);
  }
  engine.largest.push_back(largest);
  engine.distances.push_back(quantize(drawn, 0.0, largest));
}

std::pair<const char*, std::vector<double>> shape_of(const scenes::Shape& shape) {
  using Result = std::pair<const char*, std::vector<double>>;
  return std::visit(
      [](const auto& s) -> Result {
        using S = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<S, scenes::SphereShape>) {
          return {"sphere", {s.radius}};
        } else if constexpr (std::is_same_v<S, scenes::BoxShape>) {
          const Vector3<double> edges = 2 * s.half_extents;
          return {"box", {edges.x(), edges.y(), edges.z()}};
        } else if constexpr (std::is_same_v<S, scenes::PlaneShape>) {
          return {"plane", {}};
        } else if constexpr (std::is_same_v<S, scenes::CapsuleShape>) {
          return {"capsule", {s.radius, s.height}};
        } else if constexpr (std::is_same_v<S, scenes::CylinderShape>) {
          return {"cylinder", {s.radius, s.height}};
        } else if constexpr (std::is_same_v<S, scenes::ConeShape>) {
          return {"cone", {s.radius, s.height}};
        } else {
          return {"", {}};  // the page draws the simple ones only
        }
      },
      shape);
}

std::vector<DistanceViewBody> bodies_of(const SceneMetrics& metrics, const Frames& reference,
                                        const std::vector<std::size_t>& frames) {
  std::vector<DistanceViewBody> bodies;
  for (std::size_t r = 0; r < metrics.scene().colliders.size(); ++r) {
    const auto [shape, sizes] = shape_of(metrics.scene().colliders[r].shape);
    if (*shape == '\0') continue;
    DistanceViewBody body{shape, sizes, {}};
    for (const std::size_t f : frames) {
      const scenes::RigidState& rigid = reference[f].rigids.at(r);
      const Eigen::Quaterniond& q = rigid.orientation;
      body.poses.push_back(
          {rigid.position.x(), rigid.position.y(), rigid.position.z(), q.w(), q.x(), q.y(), q.z()});
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

/// Torn cloth has other nodes in every engine.
bool is_torn(const History& history) {
  for (const scenes::SceneState& frame : history.frames) {
    for (const scenes::ClothState& cloth : frame.cloths) {
      if (cloth.topology) return true;
    }
  }
  return false;
}

DistanceViewEngine engine_view(const History& history, const Frames& reference,
                               const std::vector<std::size_t>& frames,
                               const std::vector<DecimatedMesh>& cloths) {
  DistanceViewEngine engine;
  engine.name = history.engine.title();
  for (const std::size_t f : frames) {
    if (f < history.frames.size()) {
      add_frame(engine, history.frames[f], reference[f], cloths);
    } else {
      add_missing_frame(engine);
    }
  }
  return engine;
}

}  // namespace

std::vector<DistanceView> scene_distance_views(const SceneMetrics& metrics,
                                               const std::vector<History>& histories) {
  const Frames& reference = histories.back().frames;
  if (reference.empty() || histories.size() < 2 || is_torn(histories.back())) return {};
  const std::vector<DecimatedMesh> cloths = decimated_cloths(metrics);
  const std::vector<std::size_t> frames = chosen_frames(reference.size());
  DistanceView view;
  int first = 0;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    view.simulated_nodes += metrics.meshes()[c].num_nodes();
    for (const int corner : cloths[c].triangles) view.triangles.push_back(first + corner);
    first += static_cast<int>(cloths[c].nodes.size());
  }
  for (const std::size_t f : frames) {
    view.times.push_back(reference[f].time);
    view.positions.push_back(quantize(drawn_coordinates(reference[f], cloths)));
  }
  for (const History& history : histories) {
    if (&history == &histories.back() || history.frames.empty() || is_torn(history)) continue;
    view.engines.push_back(engine_view(history, reference, frames, cloths));
  }
  if (view.engines.empty()) return {};
  view.bodies = bodies_of(metrics, reference, frames);
  return {std::move(view)};
}

}  // namespace weft::validation
