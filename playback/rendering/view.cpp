#include <weft/playback/rendering/view.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <weft/playback/rendering/meshes/collider_mesh.hpp>

namespace weft::scenes {
namespace {

using Box = Eigen::AlignedBox3d;

Box collider_box(const Collider& collider) {
  Box box;
  for (const SurfaceVertex& vertex : collider_surface(collider.shape).vertices) {
    box.extend(collider.position + collider.orientation * vertex.position.cast<double>());
  }
  return box;
}

/// Largest distance of a node to the pin that is nearest at rest: what hangs below the pins. [m]
double hanging_length(const ClothMesh& mesh) {
  // Enough of each to know it to some per cent, however large the cloth is.
  constexpr std::size_t kMaxPins = 64;
  constexpr int kMaxNodes = 4096;
  const std::size_t pin_step = mesh.pinned.size() / kMaxPins + 1;
  const int node_step = mesh.num_nodes() / kMaxNodes + 1;
  double longest = 0.0;
  for (int node = 0; node < mesh.num_nodes(); node += node_step) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < mesh.pinned.size(); i += pin_step) {
      const Vector3<double> way =
          mesh.rest_positions.col(node) - mesh.rest_positions.col(mesh.pinned[i]);
      nearest = std::min(nearest, way.norm());
    }
    longest = std::max(longest, nearest);
  }
  return longest;
}

/// Height that a cloth will hardly fall below: it hangs from its lowest pin, or, if free, bends over
/// what it falls on.
double lowest_reach(const ClothMesh& mesh) {
  const double low = mesh.rest_positions.row(1).minCoeff();
  if (mesh.pinned.empty()) {
    const Vector3<double> size =
        mesh.rest_positions.rowwise().maxCoeff() - mesh.rest_positions.rowwise().minCoeff();
    return low - 0.6 * size.norm();
  }
  double hold = std::numeric_limits<double>::infinity();
  for (const int node : mesh.pinned) hold = std::min(hold, mesh.rest_positions(1, node));
  // A pinned cloth can stretch below its own length.
  return std::min(low, hold - 1.1 * hanging_length(mesh));
}

const Collider* find_plane(const Scene& scene) {
  for (const Collider& collider : scene.colliders) {
    if (std::holds_alternative<PlaneShape>(collider.shape)) return &collider;
  }
  return nullptr;
}

Vector3<double> up_vector(const Vector3<double>& forward) {
  // A camera that looks straight down or up has no horizon; z takes the place of y then.
  constexpr double kAlmostParallel = 0.999;
  if (std::abs(forward.normalized().y()) > kAlmostParallel) return -Vector3<double>::UnitZ();
  return Vector3<double>::UnitY();
}

}  // namespace

Stage make_stage(const Scene& scene) {
  Box box;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = make_mesh(cloth);
    box.extend(mesh.rest_positions.rowwise().minCoeff());
    box.extend(mesh.rest_positions.rowwise().maxCoeff());
    lowest = std::min(lowest, lowest_reach(mesh));
  }
  for (const Collider& collider : scene.colliders) {
    const Box bounds = collider_box(collider);
    if (bounds.isEmpty()) continue;
    box.extend(bounds);
    lowest = std::min(lowest, bounds.min().y());
  }
  if (box.isEmpty()) {
    box.extend(scene.camera.target + Vector3<double>::Constant(1.0));
    box.extend(scene.camera.target - Vector3<double>::Constant(1.0));
    lowest = box.min().y();
  }
  Stage stage;
  const Collider* plane = find_plane(scene);
  if (plane == nullptr) box.extend(Vector3<double>(box.center().x(), lowest, box.center().z()));
  stage.center = box.center();
  stage.radius = std::max(0.5 * box.diagonal().norm(), 1e-6);
  stage.ground_is_collider = plane != nullptr;
  stage.ground_position = {stage.center.x(), lowest, stage.center.z()};
  if (plane != nullptr) {
    stage.ground_is_visible = plane->appearance.visible;
    stage.ground_color = plane->appearance.color;
    // The foot of the centre on the plane: the ground's mesh is fine only around its middle.
    const Vector3<double> normal = plane->orientation * Vector3<double>::UnitY();
    const double height = normal.dot(stage.center - plane->position);
    stage.ground_position = stage.center - height * normal;
    stage.ground_orientation = plane->orientation;
  }
  return stage;
}

Vector3<double> camera_shift(const Scene& scene, const std::vector<ClothMesh>& meshes,
                             const SceneState& state) {
  Vector3<double> shift(0, 0, 0);
  const std::string& name = scene.camera.follow;
  if (name.empty()) return shift;
  for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
    if (scene.cloths[i].name != name) continue;
    shift = state.cloths[i].positions.rowwise().mean() - meshes[i].rest_positions.rowwise().mean();
  }
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    if (scene.colliders[i].name == name)
      shift = state.rigids[i].position - scene.colliders[i].position;
  }
  return shift.allFinite() ? shift : Vector3<double>(0, 0, 0);
}

double state_radius(const Stage& stage, const Vector3<double>& shift, const SceneState& state) {
  constexpr double kStep = 1.25;
  const double largest = 8.0 * stage.radius;
  double needed = stage.radius;
  const auto include = [&](const Vector3<double>& x) {
    const double distance = (x - stage.center - shift).norm();
    if (std::isfinite(distance) && distance <= largest) needed = std::max(needed, distance);
  };
  for (const ClothState& cloth : state.cloths) {
    for (Eigen::Index i = 0; i < cloth.positions.cols(); ++i) include(cloth.positions.col(i));
  }
  for (const RigidState& rigid : state.rigids) include(rigid.position);
  double radius = stage.radius;
  while (radius < needed) radius *= kStep;
  return radius;
}

StudioLights studio_lights(const Camera& camera) {
  const Vector3<double> forward = (camera.target - camera.position).normalized();
  const Vector3<double> right = forward.cross(up_vector(forward)).normalized();
  const Vector3<double> up = Vector3<double>::UnitY();
  const Vector3<double> ahead = up.cross(right).normalized();
  StudioLights lights;
  lights.key = (-0.25 * ahead - 0.80 * right + 1.00 * up).normalized().cast<float>();
  lights.fill = (-0.80 * ahead + 0.80 * right + 0.25 * up).normalized().cast<float>();
  lights.rim = (0.90 * ahead + 0.60 * right + 0.35 * up).normalized().cast<float>();
  return lights;
}

Eigen::Matrix3d camera_axes(const Camera& camera) {
  Eigen::Matrix3d axes;
  axes.col(2) = (camera.position - camera.target).normalized();
  axes.col(0) = up_vector(-axes.col(2)).cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

View make_view(const Camera& camera, const Stage& stage, double aspect_ratio) {
  const Vector3<double> eye = camera.position - stage.center;
  Eigen::Matrix4d eye_from_world = Eigen::Matrix4d::Identity();
  eye_from_world.block<3, 3>(0, 0) = camera_axes(camera).transpose();
  eye_from_world.block<3, 1>(0, 3) = -eye_from_world.block<3, 3>(0, 0) * eye;

  // The near plane at 1/100 of the way leaves 1e-5 of the distance as depth resolution with 24
  // bits.
  const double distance = std::max(eye.norm(), stage.radius);
  const double near = 0.01 * distance;
  const double far = distance + 20.0 * stage.radius;
  const double zoom = 1.0 / std::tan(0.5 * camera.field_of_view);
  Eigen::Matrix4d clip_from_eye = Eigen::Matrix4d::Zero();
  clip_from_eye(0, 0) = zoom / aspect_ratio;
  clip_from_eye(1, 1) = zoom;
  clip_from_eye(2, 2) = -(far + near) / (far - near);
  clip_from_eye(2, 3) = -2.0 * far * near / (far - near);
  clip_from_eye(3, 2) = -1.0;
  return {(clip_from_eye * eye_from_world).cast<float>(), eye.cast<float>()};
}

Eigen::Matrix4f light_matrix(const Eigen::Vector3f& towards_light, const Eigen::Vector3f& center,
                             double radius) {
  const Eigen::Vector3f back = towards_light.normalized();
  const Eigen::Vector3f helper =
      std::abs(back.y()) < 0.9f ? Eigen::Vector3f::UnitY() : Eigen::Vector3f::UnitX();
  const Eigen::Vector3f right = helper.cross(back).normalized();
  const float scale = static_cast<float>(1.0 / radius);
  Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
  matrix.block<1, 3>(0, 0) = scale * right.transpose();
  matrix.block<1, 3>(1, 0) = scale * back.cross(right).transpose();
  matrix.block<1, 3>(2, 0) = -scale * back.transpose();
  matrix.block<3, 1>(0, 3) = -matrix.block<3, 3>(0, 0) * center;
  return matrix;
}

double grid_cell(double radius) {
  const double wanted = 0.2 * radius;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double digit = wanted / power;
  return power * (digit < 1.5 ? 1.0 : digit < 3.5 ? 2.0 : digit < 7.5 ? 5.0 : 10.0);
}

}  // namespace weft::scenes
