#pragma once

// Tested by tests/reference/integrators_test.cpp, tests/reference/implicit_integrators_test.cpp.

#include <memory>

#include <weft/reference/options.hpp>
#include <weft/reference/rigid/body_dynamics.hpp>

namespace weft::reference {

/// How hard a step was for its method.
struct IntegrationReport {
  int inner_steps = 1;        ///< accepted ones of a method that controls its error
  int rejected_steps = 0;     ///< the others
  int newton_iterations = 0;  ///< of an implicit method, over all its stages
  double residual = 0.0;      ///< largest force left on a node in a stage equation [N]
  bool converged = true;      ///< every stage equation, and every error within its tolerance
  /// Which budget of work was used up before the step was done; nullptr: none. The step means nothing.
  const char* exhausted = nullptr;
};

/// Two reports, one after the other, as one: sums, and the larger residual.
[[nodiscard]] IntegrationReport combined(const IntegrationReport& first,
                                         const IntegrationReport& second);

/// What a step does to one body before contact is looked at: x1 = x0 + h mean_velocities, v1 =
/// end_velocities. Contact changes both; only then positions are written.
struct BodyStep {
  Matrix3X<double> mean_velocities;  ///< 3 x n [m/s], (x1 - x0) / h
  Matrix3X<double> end_velocities;   ///< 3 x n [m/s]
  IntegrationReport report;
};

/// A one-step method for x' = v, v' = a(x, v).
///
/// A step is advance(), contact, x1 = x0 + h mean_velocities, finish(). Contact is an operator
/// split at the end of the step for every method, so a trajectory with contact is of order 1
/// whatever the method's own order is. For modified Euler mean and end velocity are the same
/// numbers: there the split is the usual "velocity, contact, position".
class Integrator {
 public:
  virtual ~Integrator() = default;

  [[nodiscard]] virtual IntegratorKind kind() const = 0;
  [[nodiscard]] virtual int order() const = 0;  ///< of smooth trajectories, without contact

  /// Fills step from the state of the body, which stays as it is. time_step [s], > 0. A method may
  /// remember what helps it with the next step of the same body: one integrator per body.
  virtual void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) = 0;

  /// Velocity-level laws that act after the step, on the end velocities; positions are those after
  /// the step.
  virtual void finish(BodyDynamics& /*dynamics*/, ConstMatrix3XRef<double> /*positions*/,
                      double /*time_step*/, Matrix3X<double>& /*velocities*/) {}
};

[[nodiscard]] std::unique_ptr<Integrator> make_explicit_euler();
[[nodiscard]] std::unique_ptr<Integrator> make_modified_euler();
[[nodiscard]] std::unique_ptr<Integrator> make_velocity_verlet();
[[nodiscard]] std::unique_ptr<Integrator> make_runge_kutta4();

[[nodiscard]] std::unique_ptr<Integrator> make_yoshida4();
[[nodiscard]] std::unique_ptr<Integrator> make_dormand_prince5(const IntegratorSettings& settings);
[[nodiscard]] std::unique_ptr<Integrator> make_implicit_euler();
[[nodiscard]] std::unique_ptr<Integrator> make_tr_bdf2();
[[nodiscard]] std::unique_ptr<Integrator> make_implicit_midpoint();
[[nodiscard]] std::unique_ptr<Integrator> make_generalized_alpha(double spectral_radius);

/// Throws InvalidArgument for settings out of their domain.
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(IntegratorKind kind,
                                                          const IntegratorSettings& settings = {});

}  // namespace weft::reference
