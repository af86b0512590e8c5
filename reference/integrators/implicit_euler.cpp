// Tested by tests/reference/implicit_integrators_test.cpp.

#include <weft/reference/implicit/stage_solver.hpp>
#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// v1 = v0 + h a(x1, v1), x1 = x0 + h v1. Velocity-level laws are forces like the others.
class ImplicitEuler final : public Integrator {
 public:
  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kImplicitEuler; }
  [[nodiscard]] int order() const override { return 1; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    const Body& body = dynamics.body();
    if (acceleration_.cols() == 0) acceleration_.setZero(3, body.positions.cols());
    const StageEquation equation{.positions = body.positions + time_step * body.velocities,
                                 .position_gain = time_step * time_step,
                                 .velocities = body.velocities,
                                 .velocity_gain = time_step,
                                 .accelerations = {},
                                 .time_in_step = time_step};
    step.report = stage_.solve(dynamics, equation, acceleration_);
    step.end_velocities = body.velocities + time_step * acceleration_;
    step.mean_velocities = step.end_velocities;
  }

 private:
  StageSolver stage_;
  Matrix3X<double> acceleration_;  // at the end [m/s^2]; the first guess of the next step
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler() {
  return std::make_unique<ImplicitEuler>();
}

}  // namespace weft::reference
