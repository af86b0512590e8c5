// Tested by tests/reference/integrators_test.cpp.

#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// v1 = v0 + h a(x0, v0), x1 = x0 + h v1: de Joya's scheme (2011) and Bullet's order of operations.
/// Velocity-level laws act exactly, after the step, so that the position still moves with the
/// undamped velocity. Without damping v^2 + w^2 x^2 - h w^2 x v of an oscillator is conserved to
/// round-off.
class ModifiedEuler final : public Integrator {
 public:
  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kModifiedEuler; }
  [[nodiscard]] int order() const override { return 1; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    const Body& body = dynamics.body();
    acceleration_.resize(3, body.positions.cols());
    dynamics.evaluate(body.positions, body.velocities, 0.0, BodyDynamics::VelocityLaws::kSeparate,
                      acceleration_);
    step.end_velocities = body.velocities + time_step * acceleration_;
    step.mean_velocities = step.end_velocities;
  }

  void finish(BodyDynamics& dynamics, ConstMatrix3XRef<double> positions, double time_step,
              Matrix3X<double>& velocities) override {
    dynamics.advance_velocities(positions, time_step, velocities);
  }

 private:
  Matrix3X<double> acceleration_;  // [m/s^2]
};

}  // namespace

std::unique_ptr<Integrator> make_modified_euler() {
  return std::make_unique<ModifiedEuler>();
}

}  // namespace weft::reference
