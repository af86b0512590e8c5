#include <weft/scenes/controllers/controller_manager.hpp>

#include <algorithm>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/scenes/characters/character_controller.hpp>
#include <weft/scenes/controllers/attach.hpp>
#include <weft/scenes/controllers/collider_path.hpp>
#include <weft/scenes/controllers/detail.hpp>
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

bool has_leads(const Cloth& cloth) {
  return std::any_of(cloth.moving_pins.begin(), cloth.moving_pins.end(), &is_lead);
}

struct MakeController {
  const Scene& scene;

  std::shared_ptr<Controller> operator()(const Seek& seek) const {
    const std::size_t cloth = cloth_index(scene, seek.cloth);
    return std::make_shared<SeekController>(seek, cloth, make_mesh(scene.cloths[cloth]));
  }
  std::shared_ptr<Controller> operator()(const Roll& roll) const {
    const std::size_t cloth = cloth_index(scene, roll.cloth);
    if (scene.cloths[cloth].tear) {
      throw InvalidArgument("controller: roll: cloth '" + roll.cloth +
                            "' tears, expected one that does not");
    }
    return std::make_shared<RollController>(roll, cloth, make_mesh(scene.cloths[cloth]));
  }
  std::shared_ptr<Controller> operator()(const Attach& attach) const {
    const std::size_t cloth = cloth_index(scene, attach.cloth);
    return std::make_shared<AttachController>(attach, cloth, scene);
  }
  std::shared_ptr<Controller> operator()(const Detail& detail) const {
    const std::size_t cloth = cloth_index(scene, detail.cloth);
    return std::make_shared<DetailController>(detail, cloth, scene.cloths[cloth]);
  }
};

}  // namespace

ControllerManager::ControllerManager(const Scene& scene,
                                     std::vector<std::shared_ptr<Controller>> added) {
  for (std::size_t k = 0; k < scene.colliders.size(); ++k) {
    if (!scene.colliders[k].path) continue;
    controllers_.push_back(std::make_shared<ColliderPathController>(scene.colliders[k], k));
  }
  for (const CharacterSettings& character : scene.characters) {
    controllers_.push_back(std::make_shared<CharacterController>(character, scene));
  }
  // After those that lead colliders: a collider may lead pins.
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    if (!has_leads(scene.cloths[c])) continue;
    controllers_.push_back(std::make_shared<PinPathController>(scene, c));
  }
  for (const ControllerSettings& settings : scene.controllers) {
    controllers_.push_back(std::visit(MakeController{scene}, settings));
  }
  for (auto& controller : added) controllers_.push_back(std::move(controller));
  for (const Cloth& cloth : scene.cloths) {
    pinned_.push_back(is_needed() && cloth.tear ? make_mesh(cloth).pinned : std::vector<int>());
  }
}

/// A pinned node that was split is led alike in both its places: its copies follow in the order in
/// which they were made, as in the torn mesh.
void ControllerManager::lead_copies(const SceneState& state) {
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    Matrix3X<double>& positions = commands_.cloths[c].pinned_positions;
    if (!state.cloths[c].topology || positions.cols() != std::ssize(pinned_[c])) continue;
    for (const int origin : state.cloths[c].topology->origins) {
      const auto found = std::lower_bound(pinned_[c].begin(), pinned_[c].end(), origin);
      if (found == pinned_[c].end() || *found != origin) continue;
      positions.conservativeResize(3, positions.cols() + 1);
      positions.rightCols(1) = positions.col(found - pinned_[c].begin()).eval();
    }
  }
}

const StepCommands& ControllerManager::steer(const SceneState& state, double end_time) {
  commands_.cloths.assign(state.cloths.size(), {});
  commands_.colliders.assign(state.rigids.size(), {});
  commands_.pushes.assign(state.rigids.size(), {});
  for (const auto& controller : controllers_) controller->steer(state, end_time, commands_);
  lead_copies(state);
  return commands_;
}

void ControllerManager::serialize(StateArchive& archive) {
  archive.part("controllers");
  archive.expect(controllers_.size(), "number of controllers");
  for (const auto& controller : controllers_) controller->serialize(archive);
}

}  // namespace weft::scenes
