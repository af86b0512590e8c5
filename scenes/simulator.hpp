#pragma once

// Tested by tests/engines/body_engines_test.cpp, tests/scenes/recording/run_test.cpp.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <weft/core/types.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// A numerical blow-up, reported as data.
struct BlowUp {
  int step = 0;       ///< first step (counted from 1) after which a value was out of range
  double time = 0.0;  ///< [s]
  std::string body;
  int node = 0;
  std::string reason;  ///< "position is not finite", "speed 3.1e8 m/s is over 1e6 m/s"
};

/// How far an implicit step was solved, where the engine iterates.
struct SolveReport {
  /// Largest over the cloths: root mean square distance of the nodes from where the equations of the step put them [m], a bound
  /// by estimate (bridge::StepError).
  double error = 0.0;
  bool is_within_tolerance = true;  ///< of all cloths; if not, the budget of rounds ended first
};

/// What one step did.
struct StepReport {
  int step = 0;            ///< counted from 1
  double time = 0.0;       ///< [s] at the end of the step
  double time_step = 0.0;  ///< [s] the engine really took (Bullet rounds it to single precision)
  int substeps = 1;
  int num_contacts = 0;
  /// Largest step [s] at which no mode grows, where the engine knows it (the reference).
  std::optional<double> stable_time_step;
  std::optional<SolveReport> solve;
  std::optional<BlowUp> blow_up;  ///< once set, further steps do nothing
};

struct ClothState {
  std::string name;
  Matrix3X<double> positions;   ///< 3 x n [m]
  Matrix3X<double> velocities;  ///< 3 x n [m/s]
  /// Set once the cloth is torn: it then has more nodes than its mesh. The same object for as long
  /// as nothing more tears.
  std::shared_ptr<const ClothTopology> topology = nullptr;
};

struct RigidState {
  std::string name;
  Vector3<double> position{0, 0, 0};  ///< centre of mass [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vector3<double> velocity{0, 0, 0};          ///< [m/s]
  Vector3<double> angular_velocity{0, 0, 0};  ///< world frame [rad/s]
};

/// State of everything that can move, bodies in the order of the scene.
struct SceneState {
  double time = 0.0;               ///< [s]
  std::vector<ClothState> cloths;  ///< as Scene::cloths
  std::vector<RigidState> rigids;  ///< as Scene::colliders, fixed ones too
};

class Controller;

/// The port: every engine that can run a scene. Cross-validation is a loop over simulators.
class Simulator {
 public:
  virtual ~Simulator() = default;

  /// Throws InvalidArgument for a scene that this engine cannot run.
  virtual void load(const Scene& scene) = 0;

  /// Advances by time_step [s], > 0. Never throws for a numerical blow-up: that is in the report.
  [[nodiscard]] virtual StepReport step(double time_step) = 0;

  [[nodiscard]] virtual const SceneState& state() const = 0;

  /// Controllers beside those of the scene, asked after them before every step (step_commands.hpp). Counts
  /// from the next load().
  void set_controllers(std::vector<std::shared_ptr<Controller>> controllers) {
    controllers_ = std::move(controllers);
  }

 protected:
  [[nodiscard]] const std::vector<std::shared_ptr<Controller>>& controllers() const {
    return controllers_;
  }

 private:
  std::vector<std::shared_ptr<Controller>> controllers_;
};

}  // namespace weft::scenes
