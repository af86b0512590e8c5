#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <weft/custom_forces/force_law.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::validation {

/// A deliberate mistake in a simulation. A check that does not notice it proves nothing.
struct Sabotage {
  std::string name;
  std::function<void(scenes::Scene&)> edit_scene = [](scenes::Scene&) {};
  bool flip_damping = false;  ///< every dissipative law acts with the wrong sign
  bool drop_step = false;     ///< the second step is not taken
};

[[nodiscard]] Sabotage stiffness_scaled(double factor);
[[nodiscard]] Sabotage damping_sign();
[[nodiscard]] Sabotage one_step_dropped();
[[nodiscard]] Sabotage initial_velocity_unset();  ///< of cloths and of rigid bodies
[[nodiscard]] Sabotage no_contact();
[[nodiscard]] Sabotage friction_removed();
[[nodiscard]] Sabotage wind_removed();
/// Every collider moved by shift [m].
[[nodiscard]] Sabotage colliders_moved(const Vector3<double>& shift);

/// A law with the opposite sign: dampers that drive.
[[nodiscard]] std::unique_ptr<forces::ForceLaw<double>> negated(
    std::unique_ptr<forces::ForceLaw<double>> law);

/// Runs a scene with the reference solver in this process, with a mistake, and returns its frames
/// (one per frame_interval, the first at time 0) up to end_time [s]. Stops early if it blows up.
[[nodiscard]] std::vector<scenes::SceneState> run_sabotaged(scenes::Scene scene,
                                                            const Sabotage& sabotage,
                                                            double end_time);

}  // namespace weft::validation
