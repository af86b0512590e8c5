#include <weft/scenes/controllers/director.hpp>

#include <utility>

#include <weft/custom_forces/core/error.hpp>
#include <weft/scenes/characters/character_controller.hpp>
#include <weft/scenes/controllers/collider_path.hpp>
#include <weft/scenes/controllers/pin_path.hpp>
#include <weft/scenes/controllers/roll.hpp>
#include <weft/scenes/controllers/seek.hpp>

namespace weft::scenes {
namespace {

std::size_t cloth_index(const Scene& scene, const std::string& name) {
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    if (scene.cloths[c].name == name) return c;
  }
  throw InvalidArgument("controller: cloth = '" + name + "', expected a cloth of the scene");
}

bool has_path(const Cloth& cloth) {
  for (const MovingPin& pin : cloth.moving_pins) {
    if (pin.path) return true;
  }
  return false;
}

struct MakeController {
  const Scene& scene;

  std::shared_ptr<Controller> operator()(const Seek& seek) const {
    const std::size_t cloth = cloth_index(scene, seek.cloth);
    return std::make_shared<SeekController>(seek, cloth, make_mesh(scene.cloths[cloth]));
  }
  std::shared_ptr<Controller> operator()(const Roll& roll) const {
    const std::size_t cloth = cloth_index(scene, roll.cloth);
    return std::make_shared<RollController>(roll, cloth, make_mesh(scene.cloths[cloth]));
  }
};

}  // namespace

Director::Director(const Scene& scene, std::vector<std::shared_ptr<Controller>> added) {
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    if (!has_path(scene.cloths[c])) continue;
    controllers_.push_back(std::make_shared<PinPathController>(scene.cloths[c], c));
  }
  for (std::size_t k = 0; k < scene.colliders.size(); ++k) {
    if (!scene.colliders[k].path) continue;
    controllers_.push_back(std::make_shared<ColliderPathController>(scene.colliders[k], k));
  }
  for (const CharacterSettings& character : scene.characters) {
    controllers_.push_back(std::make_shared<CharacterController>(character, scene));
  }
  for (const ControllerSettings& settings : scene.controllers) {
    controllers_.push_back(std::visit(MakeController{scene}, settings));
  }
  for (auto& controller : added) controllers_.push_back(std::move(controller));
}

const Steering& Director::steer(const SceneState& state, double end_time) {
  steering_.cloths.assign(state.cloths.size(), {});
  steering_.colliders.assign(state.rigids.size(), {});
  for (const auto& controller : controllers_) controller->steer(state, end_time, steering_);
  return steering_;
}

}  // namespace weft::scenes
