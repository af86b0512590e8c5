#pragma once

#include <functional>
#include <string>
#include <vector>

#include <weft/mesh/cloth_mesh.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// Runs a scene on the first engine that it names, in single precision, and looks at every frame and at every step.
/// Fails the test if the run blows up.
void run_scene(
    const Scene& scene, const std::function<void(const SceneState&)>& look,
    const std::function<void(const StepReport&)>& read = [](const StepReport&) {});

/// How a scene's steps were solved on bullet_weft, as the solver says.
struct SolveNumbers {
  double unsolved_share = 0.0;  ///< of all steps [-]
  double largest_error = 0.0;   ///< of a step [m]
};
[[nodiscard]] SolveNumbers measure_solves(Scene scene);

/// What all frames of a run have in common.
struct RunNumbers {
  double deepest = 0.0;      ///< [m] of any node below any surface
  double deepest_end = 0.0;  ///< [m] in the last frame
  int most_piercings = 0;    ///< edges through triangles, of any cloth through itself or another
  int piercings_end = 0;     ///< in the last frame
  double fastest_end = 0.0;  ///< [m/s] of any node in the last frame
  std::vector<Matrix3X<double>> end;  ///< positions in the last frame [m], per cloth
};
[[nodiscard]] RunNumbers measure_scene(const Scene& scene);

}  // namespace weft::scenes
