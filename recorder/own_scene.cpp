#include <weft/recorder/own_scene.hpp>

#include <cmath>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// The duration of a loop is not known when its scene is written: so many frame intervals.
constexpr double kNominalFrames = 1e6;

/// Space around the bodies of the first frame, as a factor on the distance that just shows them.
constexpr double kViewSpace = 1.5;

Vector3<double> vector_of(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

}  // namespace

scenes::Scene empty_scene(const RecorderOptions& options) {
  if (!(options.frame_interval > 0) || !std::isfinite(options.frame_interval)) {
    throw InvalidArgument(fmt::format("recorder: frame_interval = {} [s], expected > 0 and finite",
                                      options.frame_interval));
  }
  scenes::Scene scene;
  scene.name = options.name;
  scene.summary = options.summary;
  scene.world.time_step = options.frame_interval;
  scene.world.frame_interval = options.frame_interval;
  scene.world.duration = kNominalFrames * options.frame_interval;
  if (options.gravity) scene.world.gravity = vector_of(*options.gravity);
  if (options.view) {
    scene.camera.position = vector_of(options.view->position);
    scene.camera.target = vector_of(options.view->target);
  }
  return scene;
}

void require_readable(scenes::Scene scene, const std::string& what) {
  if (scene.cloths.empty()) {  // a scene needs one, which must not have the name of a collider
    scenes::Cloth& cloth = scene.cloths.emplace_back();
    cloth.name = scene.colliders.empty() || scene.colliders[0].name != "cloth" ? "cloth" : "other";
  }
  try {
    (void)scenes::read_scene_text(scenes::write_scene(scene), "scene");
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(fmt::format("{}: {}", what, error.what()));
  }
}

scenes::Camera view_of(const scenes::Scene& scene, const scenes::SceneState& state) {
  Eigen::AlignedBox3d box;
  for (const scenes::ClothState& cloth : state.cloths) {
    for (const auto& position : cloth.positions.colwise()) {
      if (position.allFinite()) box.extend(position);
    }
  }
  for (std::size_t r = 0; r < state.rigids.size(); ++r) {
    if (!scene.colliders[r].mass) continue;
    const scenes::RigidState& rigid = state.rigids[r];
    const scenes::MeshShape surface = scenes::shape_surface(scene.colliders[r].shape, 8);
    for (const auto& point : surface.points.colwise()) {
      const Vector3<double> position = rigid.position + rigid.orientation * point;
      if (position.allFinite()) box.extend(position);
    }
  }
  scenes::Camera camera;
  if (box.isEmpty() || !(box.diagonal().norm() > 0)) return camera;
  const double distance =
      kViewSpace * 0.5 * box.diagonal().norm() / std::sin(0.5 * camera.field_of_view);
  camera.target = box.center();
  camera.position = camera.target + distance * Vector3<double>(0.6, 0.4, 0.7).normalized();
  return camera;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
