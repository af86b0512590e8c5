// Tested by tests/reference/implicit_integrators_test.cpp.

#include <numbers>

#include <weft/reference/implicit/stage_solver.hpp>
#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// The trapezoidal rule over g h, then the backward differentiation formula of order 2 over the
/// step, with g = 2 - sqrt 2 (Bank et al. 1985; as a Runge-Kutta method Hosea and Shampine 1996).
/// On z = (x, v) with z' = F(z, t) and d = g / 2:
///
///   zg = z0 + d h (F0 + Fg)
///   z1 = z0 + r (zg - z0) + d h F1,  r = 1 / (g (2 - g))
///
/// Both stages have one and the same matrix. L-stable: what the step does not resolve is gone after
/// it. Velocity-level laws are forces like the others.
class TrBdf2 final : public Integrator {
 public:
  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kTrBdf2; }
  [[nodiscard]] int order() const override { return 2; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    constexpr double kPart = 2.0 - std::numbers::sqrt2;       // g
    constexpr double kRatio = 1.0 / (kPart * (2.0 - kPart));  // r
    const double weight = 0.5 * kPart * time_step;            // d h [s]
    const Body& body = dynamics.body();
    const Matrix3X<double>& x0 = body.positions;
    const Matrix3X<double>& v0 = body.velocities;
    start_.resize(3, x0.cols());
    dynamics.evaluate(x0, v0, 0.0, BodyDynamics::VelocityLaws::kAsForces, start_);
    if (middle_.cols() == 0) middle_ = end_ = Matrix3X<double>::Zero(3, x0.cols());

    const Matrix3X<double> first_velocities = v0 + weight * start_;
    step.report =
        solve(dynamics, x0 + weight * v0, first_velocities, weight, kPart * time_step, middle_);
    const Matrix3X<double> vg = first_velocities + weight * middle_;
    const Matrix3X<double> moved = weight * (v0 + vg);  // xg - x0

    const Matrix3X<double> second_velocities = v0 + kRatio * (vg - v0);
    step.report = combined(step.report, solve(dynamics, x0 + kRatio * moved, second_velocities,
                                              weight, time_step, end_));
    step.report.inner_steps = 1;
    step.end_velocities = second_velocities + weight * end_;
    step.mean_velocities = (kRatio * moved + weight * step.end_velocities) / time_step;
  }

 private:
  /// Solves z = base + weight F(z) for its acceleration y.
  IntegrationReport solve(BodyDynamics& dynamics, const Matrix3X<double>& base_positions,
                          const Matrix3X<double>& base_velocities, double weight, double time,
                          Matrix3X<double>& y) {
    const StageEquation equation{.positions = base_positions + weight * base_velocities,
                                 .position_gain = weight * weight,
                                 .velocities = base_velocities,
                                 .velocity_gain = weight,
                                 .accelerations = {},
                                 .time_in_step = time};
    return stage_.solve(dynamics, equation, y);
  }

  StageSolver stage_;
  Matrix3X<double> start_;         // a(x0, v0) [m/s^2]
  Matrix3X<double> middle_, end_;  // [m/s^2]; the first guesses of the next step
};

}  // namespace

std::unique_ptr<Integrator> make_tr_bdf2() {
  return std::make_unique<TrBdf2>();
}

}  // namespace weft::reference
