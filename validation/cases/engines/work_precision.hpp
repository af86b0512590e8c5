#pragma once

#include <string>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>

namespace weft::validation {

/// A small scene in which precision is held against the time that it costs.
struct WorkStudy {
  std::string scene;                 ///< of the catalog; its cloth is made coarser
  int nodes;                         ///< per side of the cloth
  double duration;                   ///< [s]
  std::vector<int> steps_per_frame;  ///< three; of the frame interval, coarsest first
  int finest_steps_per_frame;  ///< of the finest converged run; two more have 1/2 and 1/4 of it
  double allowed_error;        ///< [m] of the converged reference, RMS
};

/// One run of a study: an engine with a step and, where it has them, iterations.
struct WorkRun {
  EngineChoice engine;
  std::string series;  ///< runs that belong together, "bullet_soft float32, 1/100 s"
  int steps_per_frame;
  int iterations;  ///< 0: the engine has none
  scenes::Integrator integrator = scenes::Integrator::kModifiedEuler;
  [[nodiscard]] std::string label(const std::string& study) const;
};

[[nodiscard]] const std::vector<WorkStudy>& work_studies();
/// The runs of a study without the converged ones.
[[nodiscard]] std::vector<WorkRun> work_runs(const WorkStudy& study, bool with_bullet);
/// The converged reference, coarse to fine: three levels, Runge-Kutta 4.
[[nodiscard]] std::vector<WorkRun> converged_runs(const WorkStudy& study);
[[nodiscard]] scenes::Scene work_scene(const WorkStudy& study, const WorkRun& run);

/// Indices of the points that no other beats in both numbers, cheapest first; points that are not
/// finite and positive never are among them.
[[nodiscard]] std::vector<std::size_t> pareto_front(const std::vector<double>& work,
                                                    const std::vector<double>& error);

}  // namespace weft::validation
