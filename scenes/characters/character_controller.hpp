#pragma once

// Tested by tests/scenes/catalog/caped_figure_test.cpp, tests/scenes/catalog/public_character_test.cpp.

#include <cstddef>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// Leads what belongs to a character: attached nodes and skins stand exactly where the bones have them
/// at the end of each step, free nodes get their limits there, colliders follow their bones.
class CharacterController final : public Controller {
 public:
  /// settings: one of scene.characters. Throws InvalidArgument for names that the scene or the model
  /// does not have.
  CharacterController(const CharacterSettings& settings, const Scene& scene);

  void steer(const SceneState& state, double end_time, StepCommands& commands) override;
  void serialize(StateArchive& /*archive*/) override {}

 private:
  struct AnimatedCloth {
    std::size_t index;  ///< in the scene
    std::shared_ptr<const characters::Part> part;
    std::vector<int> pinned;
    VectorX<double> max_distances;  ///< [m]; empty: no limits
    double backstop_radius;         ///< [m]
    double backstop_offset;         ///< [m]
  };
  struct LedCollider {
    std::size_t index;  ///< in the scene
    std::size_t bone;
    Pose place;
  };
  void add_cloth(const std::string& name, const ReachSettings& reach, const Scene& scene);
  [[nodiscard]] PositionLimits limits_of(const AnimatedCloth& cloth,
                                         const Matrix3X<double>& skin) const;

  std::shared_ptr<const CharacterModel> model_;
  CharacterPose pose_;
  std::vector<AnimatedCloth> cloths_;
  std::vector<LedCollider> colliders_;
};

/// Place of a collider that a bone leads, from the bone's frame in the world.
[[nodiscard]] Pose led_pose(const Eigen::Affine3d& frame, const Pose& place);

}  // namespace weft::scenes
