#include <weft/viewer/model/picking.hpp>

#include <algorithm>
#include <cmath>

#include <weft/playback/rendering/meshes/collider_mesh.hpp>
#include <weft/playback/rendering/view.hpp>
#include <weft/viewer/model/orbit.hpp>

namespace weft::viewer {
namespace {

constexpr double kReach = 1.0 / 30.0;  // [height of the picture]
/// A node in front wins over one behind that is nearer to the place by less than this.
constexpr double kSamePlace = 1.0 / 100.0;  // [height of the picture]

/// How far along a ray a triangle is, in lengths of the ray's direction; none beside it or behind (Moeller and Trumbore 1997).
std::optional<double> hit(const Vector3<double>& start, const Vector3<double>& direction,
                          const Vector3<double>& a, const Vector3<double>& b,
                          const Vector3<double>& c) {
  const Vector3<double> ab = b - a;
  const Vector3<double> ac = c - a;
  const Vector3<double> p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0.0) return std::nullopt;
  const Vector3<double> way = start - a;
  const double u = way.dot(p) / determinant;
  const Vector3<double> q = way.cross(ab);
  const double v = direction.dot(q) / determinant;
  const double distance = ac.dot(q) / determinant;
  if (u < 0.0 || v < 0.0 || u + v > 1.0 || !(distance > 0.0)) return std::nullopt;
  return distance;
}

/// The same for a whole surface.
std::optional<double> hit(const Vector3<double>& start, const Vector3<double>& direction,
                          const scenes::SurfaceMesh& surface) {
  std::optional<double> nearest;
  const auto corner = [&](std::size_t i) -> Vector3<double> {
    return surface.vertices[surface.indices[i]].position.cast<double>();
  };
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    const auto found = hit(start, direction, corner(i), corner(i + 1), corner(i + 2));
    if (found && (!nearest || *found < *nearest)) nearest = found;
  }
  return nearest;
}

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

std::optional<SeenCollider> pick_collider(const scenes::Camera& camera, double aspect,
                                          const Place& place, const scenes::Scene& scene,
                                          const scenes::SceneState& state) {
  const Vector3<double> direction =
      point_at(camera, aspect, place, camera.target) - camera.position;
  std::optional<SeenCollider> best;
  double nearest = 0.0;
  for (std::size_t k = 0; k < std::min(scene.colliders.size(), state.rigids.size()); ++k) {
    if (!scene.colliders[k].appearance.visible) continue;
    const scenes::RigidState& rigid = state.rigids[k];
    const Eigen::Quaterniond back = rigid.orientation.conjugate();
    const auto found = hit(back * (camera.position - rigid.position), back * direction,
                           scenes::collider_surface(scene.colliders[k].shape));
    if (!found || (best && *found >= nearest)) continue;
    nearest = *found;
    best = SeenCollider{k, camera.position + *found * direction};
  }
  return best;
}

}  // namespace weft::viewer
