#pragma once

// Tested by tests/viewer/live/step_parts_test.cpp.

#include <string_view>

#include <weft/custom_forces/law_set.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::viewer {

/// Into how many parts a step is divided, so that laws which the user has changed do not blow it up: a
/// scene's time step is made for the scene's own laws. Springs of explicit engines count, and for every
/// engine what acts explicitly (wind on light cloth).
class StepParts {
 public:
  static constexpr int kMaxParts = 64;

  /// Engines that refuse another step than the scene's, as bullet_soft, always get 1.
  explicit StepParts(std::string_view engine);

  /// Sets the laws that steps are divided for. Before the first call a step is whole, whatever it is.
  void set_laws(const scenes::Scene& scene);

  /// 1 to kMaxParts for the next step of time_step [s].
  [[nodiscard]] int count(const scenes::SceneState& state, double time_step);

 private:
  struct Body {
    forces::LawSet<double> laws;
    VectorX<double> masses;
    VectorX<double> inverse_masses;
    Matrix3X<double>
        stiffest;  ///< approximate eigenvector of the stiffness, from estimate to estimate
    Matrix3X<double> dampest;  ///< and of the damping
  };
  [[nodiscard]] double critical_step(const scenes::SceneState& state);

  bool can_divide_;
  bool springs_are_implicit_;
  std::vector<Body> bodies_;    ///< empty before set_laws()
  double critical_step_ = 0.0;  ///< [s] at the last estimate
  int steps_since_estimate_ = 0;
};

}  // namespace weft::viewer
