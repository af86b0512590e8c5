// Tested by tests/reference/implicit_integrators_test.cpp.

#include <weft/reference/implicit/stage_solver.hpp>
#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// The generalised alpha method of Chung and Hulbert (1993), with rho = spectral_radius:
///
///   am = (2 rho - 1) / (rho + 1), af = rho / (rho + 1), g = 1/2 - am + af, b = (1 - am + af)^2 / 4
///   x1 = x0 + h v0 + h^2 ((1/2 - b) a0 + b a1),  v1 = v0 + h ((1 - g) a0 + g a1)
///   M ((1 - am) a1 + am a0) = f at (1 - af) end + af start, of x, v and t
///
/// a is a number of the method, carried from step to step; at first it is the acceleration. Contact
/// does not change it. Velocity-level laws are forces like the others.
class GeneralizedAlpha final : public Integrator {
 public:
  explicit GeneralizedAlpha(double rho)
      : mass_((2 * rho - 1) / (rho + 1)), force_(rho / (rho + 1)) {}

  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kGeneralizedAlpha; }
  [[nodiscard]] int order() const override { return 2; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    const Body& body = dynamics.body();
    if (acceleration_.cols() == 0) {
      acceleration_.resize(3, body.positions.cols());
      dynamics.evaluate(body.positions, body.velocities, 0.0, BodyDynamics::VelocityLaws::kAsForces,
                        acceleration_);
      next_ = acceleration_;
    }
    const double h = time_step;
    const double gamma = 0.5 - mass_ + force_;
    const double beta = 0.25 * (1 - mass_ + force_) * (1 - mass_ + force_);
    const double end = 1 - force_;
    const Matrix3X<double> moved =
        body.velocities + h * (0.5 - beta) * acceleration_;  // (x1 - x0) / h without a1
    const Matrix3X<double> faster = h * (1 - gamma) * acceleration_;
    const StageEquation equation{.positions = body.positions + end * h * moved,
                                 .position_gain = end * h * h * beta,
                                 .velocities = body.velocities + end * faster,
                                 .velocity_gain = end * h * gamma,
                                 .accelerations = mass_ * acceleration_,
                                 .acceleration_gain = 1 - mass_,
                                 .time_in_step = end * h};
    step.report = stage_.solve(dynamics, equation, next_);
    step.mean_velocities = moved + h * beta * next_;
    step.end_velocities = body.velocities + faster + h * gamma * next_;
    acceleration_ = next_;
  }

 private:
  double mass_, force_;  // am, af [-]
  StageSolver stage_;
  Matrix3X<double> acceleration_, next_;  // a0, a1 [m/s^2]
};

}  // namespace

std::unique_ptr<Integrator> make_generalized_alpha(double spectral_radius) {
  return std::make_unique<GeneralizedAlpha>(spectral_radius);
}

}  // namespace weft::reference
