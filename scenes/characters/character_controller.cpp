#include <weft/scenes/characters/character_controller.hpp>

#include <algorithm>
#include <utility>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

template <class Bodies>
std::size_t index_of(const Bodies& bodies, const std::string& name, const std::string& what) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].name == name) return i;
  }
  throw InvalidArgument("character: " + what + " '" + name + "' is not in the scene");
}

}  // namespace

Pose led_pose(const Eigen::Affine3d& frame, const Pose& place) {
  // The nearest rotation: frames contain the scale, and animated scales may shear.
  const Eigen::Quaterniond turn = Eigen::Quaterniond(frame.rotation()).normalized();
  return {frame.translation() + turn * place.position, (turn * place.orientation).normalized()};
}

CharacterController::CharacterController(const CharacterSettings& settings, const Scene& scene)
    : model_(settings.model), pose_(settings.pose) {
  for (const std::string& skin : settings.skins) add_cloth(skin, {}, scene);
  for (const CharacterCloth& cloth : settings.cloths) add_cloth(cloth.cloth, cloth.reach, scene);
  for (const CharacterCollider& collider : settings.colliders) {
    const int bone = find_bone(model_->character.skeleton, collider.bone);
    colliders_.push_back({index_of(scene.colliders, collider.collider, "collider"),
                          static_cast<std::size_t>(bone), collider.place});
  }
}

void CharacterController::add_cloth(const std::string& name, const ReachSettings& reach,
                                    const Scene& scene) {
  AnimatedCloth led;
  led.index = index_of(scene.cloths, name, "cloth");
  const Cloth& cloth = scene.cloths[led.index];
  const auto* source = std::get_if<SkinSource>(&cloth.source);
  if (source == nullptr) {
    throw InvalidArgument("character: cloth '" + name + "' is no part of a model");
  }
  led.part = source->part;
  led.pinned = make_mesh(cloth).pinned;
  led.backstop_radius = reach.backstop_radius;
  led.backstop_offset = reach.backstop_offset;
  if (source->is_cloth && (reach.max_distance || reach.backstop_radius > 0)) {
    led.max_distances = max_distances(reach, *source);
  }
  cloths_.push_back(std::move(led));
}

PositionLimits CharacterController::limits_of(const AnimatedCloth& cloth,
                                              const Matrix3X<double>& skin) const {
  PositionLimits limits;
  if (cloth.max_distances.size() == 0) return limits;
  limits.centers = skin;
  limits.max_distances = cloth.max_distances;
  if (cloth.backstop_radius > 0) {
    limits.normals = vertex_normals(skin, cloth.part->triangles);
    limits.backstop_radii = VectorX<double>::Constant(skin.cols(), cloth.backstop_radius);
    limits.backstop_offsets = VectorX<double>::Constant(skin.cols(), cloth.backstop_offset);
  }
  return limits;
}

void CharacterController::steer(const SceneState&, double end_time, StepCommands& commands) {
  const std::vector<Eigen::Affine3d> frames = world_frames(*model_, pose_, end_time);
  for (const AnimatedCloth& cloth : cloths_) {
    ClothCommands& lead = commands.cloths[cloth.index];
    lead.animated_positions = skinned_positions(*cloth.part, frames);
    const Matrix3X<double>& skin = lead.animated_positions;
    lead.pinned_positions = skin(Eigen::all, cloth.pinned);
    lead.limits = limits_of(cloth, skin);
  }
  for (const LedCollider& collider : colliders_) {
    commands.colliders[collider.index] = led_pose(frames[collider.bone], collider.place);
  }
}

}  // namespace weft::scenes
