#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <weft/core/state_archive.hpp>
#include <weft/mesh/position_limits.hpp>
#include <weft/reference/blow_up.hpp>
#include <weft/reference/contact/contact_model.hpp>
#include <weft/reference/integrators/integrator.hpp>
#include <weft/reference/options.hpp>
#include <weft/reference/step_guard.hpp>
#include <weft/reference/system.hpp>

namespace weft::reference {

/// What one step did.
struct StepOutcome {
  int substeps = 1;
  double stable_step = 0.0;       ///< [s], as last estimated; infinite if nothing limits it
  bool is_step_stable = true;     ///< the (sub)step is below it
  IntegrationReport integration;  ///< all bodies and substeps
  ContactOutcome contact;  ///< impulses and sweeps summed over substeps, contacts of the last one
  /// Once set, further steps do nothing. Found before contact looks at the step, if it is there.
  std::optional<BlowUp> blow_up;
};

/// The reference spring solver: double precision, no engine, every number of a step documented and
/// tested. Deterministic: the same system and steps give the same bits, for any number of threads.
class SpringSolver {
 public:
  /// Throws InvalidArgument for a system that check_system() refuses.
  explicit SpringSolver(System system, SolverOptions options = {});

  /// Advances by time_step [s]. Throws InvalidArgument for a step that is not positive and finite,
  /// or that the guard refuses; a numerical blow-up is in the outcome.
  StepOutcome step(double time_step);

  /// Puts another body in place of one, between two steps: the same cloth after it tore. Throws
  /// InvalidArgument as the constructor, and for a number that no body has; nothing changes then.
  /// The stable step is estimated anew where the guard acts on it, else when it is due.
  void replace_body(std::size_t index, Body body);

  [[nodiscard]] const System& system() const { return *system_; }
  /// Leads what has no free motion, for steps to come: pinned nodes reach targets, 3 x pinned.size()
  /// [m], in a step of time_step [s]. Throws InvalidArgument for another number of targets.
  void lead_pins(std::size_t body, ConstMatrix3XRef<double> targets, double time_step);
  /// After that step: puts them there exactly.
  void place_pins(std::size_t body, ConstMatrix3XRef<double> targets);
  /// After that step, of time_step [s]: moves free nodes to where their limits allow them and adds the way
  /// divided by time_step to their velocities. Throws InvalidArgument for limits that do not fit.
  void limit_positions(std::size_t body, const PositionLimits& limits, double time_step);
  /// Sets Body::external_forces, 3 x n [N] or empty. Throws InvalidArgument for another size.
  void set_external_forces(std::size_t body, const Matrix3X<double>& forces);
  /// A collider without a mass reaches a place and an orientation in a step of time_step [s]. Throws
  /// InvalidArgument for one with a mass.
  void lead_collider(std::size_t collider, const Vector3<double>& position,
                     const Eigen::Quaterniond& orientation, double time_step);
  /// After that step: puts it there exactly.
  void place_collider(std::size_t collider, const Vector3<double>& position,
                      const Eigen::Quaterniond& orientation);
  /// An impulse on a collider with a mass before the step of time_step [s]: force [N] and torque [N m]
  /// about its position. Does nothing to one without.
  void push_collider(std::size_t collider, const Vector3<double>& force,
                     const Vector3<double>& torque, double time_step);

  [[nodiscard]] const SolverOptions& options() const { return options_; }
  [[nodiscard]] double time() const { return time_; }  ///< [s]

  /// All that the next steps depend on beside meshes and laws, for the system that was saved. Integrators that remember
  /// start anew in both directions, so that going on after a snapshot and coming back to it give the same bits.
  void serialize(StateArchive& archive);

  /// Estimate at the present state, whatever the policy.
  [[nodiscard]] Stability stability();

 private:
  void substep(double time, double time_step, StepOutcome& outcome);
  void write(double time_step);
  [[nodiscard]] std::optional<BlowUp> find_non_finite_force() const;
  [[nodiscard]] std::optional<BlowUp> find_exhausted() const;

  std::unique_ptr<System> system_;  // on the heap: dynamics_ refer to its bodies
  SolverOptions options_;
  std::vector<std::unique_ptr<Integrator>> integrators_;  // one per body
  std::unique_ptr<ContactModel> contact_;
  std::vector<BodyDynamics> dynamics_;
  SystemStep motion_;
  std::optional<Stability> stability_;
  std::optional<BlowUp> blow_up_;
  double time_ = 0.0;
  int steps_since_estimate_ = 0;
};

}  // namespace weft::reference
