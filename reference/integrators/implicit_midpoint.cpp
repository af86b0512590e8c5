// Tested by tests/reference/implicit_integrators_test.cpp.

#include <weft/reference/implicit/stage_solver.hpp>
#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// a = a((x0 + x1) / 2, (v0 + v1) / 2), v1 = v0 + h a, x1 = x0 + h (v0 + v1) / 2: the Gauss method
/// of one stage. Symplectic, and symmetric in time; keeps quadratic invariants, so angular momentum
/// and the energy of a linear system. Velocity-level laws are forces like the others.
class ImplicitMidpoint final : public Integrator {
 public:
  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kImplicitMidpoint; }
  [[nodiscard]] int order() const override { return 2; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    const Body& body = dynamics.body();
    const double half = 0.5 * time_step;
    if (acceleration_.cols() == 0) acceleration_.setZero(3, body.positions.cols());
    const StageEquation equation{.positions = body.positions + half * body.velocities,
                                 .position_gain = half * half,
                                 .velocities = body.velocities,
                                 .velocity_gain = half,
                                 .accelerations = {},
                                 .time_in_step = half};
    step.report = stage_.solve(dynamics, equation, acceleration_);
    step.mean_velocities = body.velocities + half * acceleration_;
    step.end_velocities = body.velocities + time_step * acceleration_;
  }

 private:
  StageSolver stage_;
  Matrix3X<double> acceleration_;  // in the middle [m/s^2]; the first guess of the next step
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_midpoint() {
  return std::make_unique<ImplicitMidpoint>();
}

}  // namespace weft::reference
