#include <weft/viewer/model/picking.hpp>

#include <algorithm>
#include <cmath>

#include <weft/playback/rendering/view.hpp>
#include <weft/viewer/model/orbit.hpp>

namespace weft::viewer {
namespace {

constexpr double kReach = 1.0 / 30.0;  // [height of the picture]
/// A node in front wins over one behind that is nearer to the place by less than this.
constexpr double kSamePlace = 1.0 / 100.0;  // [height of the picture]

}  // namespace

scenes::Camera followed(const scenes::Scene& scene, const scenes::Camera& camera,
                        const scenes::SceneState& state) {
  if (scene.camera.follow.empty()) return camera;
  std::vector<ClothMesh> meshes;
  for (const scenes::Cloth& cloth : scene.cloths) meshes.push_back(scenes::make_mesh(cloth));
  scenes::Camera moved = camera;
  const Vector3<double> shift = scenes::camera_shift(scene, meshes, state);
  moved.position += shift;
  moved.target += shift;
  return moved;
}

std::optional<Place> project(const scenes::Camera& camera, double aspect,
                             const Vector3<double>& point) {
  const CameraFrame frame = frame_of(camera);
  const Vector3<double> way = point - camera.position;
  const double depth = -frame.back.dot(way);
  if (!(depth > 0.0)) return std::nullopt;
  const double height = 2.0 * std::tan(0.5 * camera.field_of_view) * depth;
  return Place{0.5 + frame.right.dot(way) / (height * aspect), 0.5 - frame.up.dot(way) / height};
}

Vector3<double> point_at(const scenes::Camera& camera, double aspect, const Place& place,
                         const Vector3<double>& as_far_as) {
  const CameraFrame frame = frame_of(camera);
  const double depth = std::max(-frame.back.dot(as_far_as - camera.position), 1e-6);
  const double height = 2.0 * std::tan(0.5 * camera.field_of_view) * depth;
  return camera.position - depth * frame.back + (place.x - 0.5) * height * aspect * frame.right +
         (0.5 - place.y) * height * frame.up;
}

std::optional<NodeId> pick(const scenes::Camera& camera, double aspect, const Place& place,
                           const scenes::SceneState& state, std::size_t num_cloths) {
  std::optional<NodeId> best;
  double best_score = kReach;
  const double nearest = (camera.position - camera.target).norm();
  for (std::size_t c = 0; c < std::min(num_cloths, state.cloths.size()); ++c) {
    const Matrix3X<double>& positions = state.cloths[c].positions;
    for (Eigen::Index i = 0; i < positions.cols(); ++i) {
      const auto seen = project(camera, aspect, positions.col(i));
      if (!seen) continue;
      const double distance = std::hypot((seen->x - place.x) * aspect, seen->y - place.y);
      if (!(distance < kReach)) continue;
      const double depth = (positions.col(i) - camera.position).norm() / nearest;
      const double score = distance + kSamePlace * depth;
      if (best && score >= best_score) continue;
      best_score = score;
      best = NodeId{c, static_cast<int>(i)};
    }
  }
  return best;
}

}  // namespace weft::viewer
