// Tested by tests/reference/integrators_test.cpp.

#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// x1 = x0 + h v0, v1 = v0 + h a(x0, v0). Velocity-level laws are forces like the others.
/// Every undamped mode grows by sqrt(1 + (h omega)^2) per step, at any step: kept as the control
/// that explodes.
class ExplicitEuler final : public Integrator {
 public:
  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kExplicitEuler; }
  [[nodiscard]] int order() const override { return 1; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    const Body& body = dynamics.body();
    acceleration_.resize(3, body.positions.cols());
    dynamics.evaluate(body.positions, body.velocities, 0.0, BodyDynamics::VelocityLaws::kAsForces,
                      acceleration_);
    step.mean_velocities = body.velocities;
    step.end_velocities = body.velocities + time_step * acceleration_;
  }

  void finish(BodyDynamics& /*dynamics*/, ConstMatrix3XRef<double> /*positions*/,
              double /*time_step*/, Matrix3X<double>& /*velocities*/) override {}

 private:
  Matrix3X<double> acceleration_;  // [m/s^2]
};

}  // namespace

std::unique_ptr<Integrator> make_explicit_euler() {
  return std::make_unique<ExplicitEuler>();
}

}  // namespace weft::reference
