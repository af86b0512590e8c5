#pragma once

// Tested by tests/engines/bullet/bullet_shapes_test.cpp, tests/scenes/catalog/tear_test.cpp.

#include <optional>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {

/// The bodies of a scene in one of Bullet's worlds, and their state as the port reports it.
class BulletBodies {
 public:
  /// mesh and body are the cloth's; its free nodes get the cloth's initial velocity.
  void add(const Cloth& cloth, const ClothMesh& mesh, btSoftBody& body);
  void add(const Collider& collider, btRigidBody& body);
  /// A cloth that has torn: nodes of its body were split, and with them its pins.
  void set_torn(std::size_t cloth, const ClothMesh& mesh,
                std::shared_ptr<const ClothTopology> topology);
  /// Before every step: pins move as the mesh says, or as commands does; so do colliders that are
  /// led, and the forces of controllers are added. commands may be nullptr. time_step [s] is that
  /// which Bullet takes.
  void begin_step(const StepCommands* commands, double time_step);
  /// After begin_step(): the first rigid body that its forces are about to make explode, with step and
  /// time [s] of the report. Bullet's contact stage is not for such velocities.
  [[nodiscard]] std::optional<BlowUp> predicted_blow_up(int step, double time,
                                                        double time_step) const;
  /// After the step: puts what was led exactly where it shall be.
  void end_step(const StepCommands* commands, double time_step);
  /// Reads all positions and velocities from Bullet; time is [s].
  void read_state(double time);

  [[nodiscard]] const std::vector<btSoftBody*>& cloths() const { return cloths_; }
  [[nodiscard]] const SceneState& state() const { return state_; }

 private:
  std::vector<btSoftBody*> cloths_;
  std::vector<ClothMesh> steered_;  ///< as cloths_: pins and their velocities, nothing else
  std::vector<btRigidBody*> rigids_;
  std::vector<Vector3<double>> rigid_offsets_;  ///< [m] see bullet_shape_offset()
  SceneState state_;
};

}  // namespace weft::scenes
