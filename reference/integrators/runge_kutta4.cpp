// Tested by tests/reference/integrators_test.cpp.

#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// The classical Runge-Kutta method of order 4 on (x, v). Velocity-level laws are forces like the
/// others.
class RungeKutta4 final : public Integrator {
 public:
  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kRungeKutta4; }
  [[nodiscard]] int order() const override { return 4; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    const Body& body = dynamics.body();
    const Eigen::Index num_nodes = body.positions.cols();
    acceleration_.resize(3, num_nodes);
    velocity_ = body.velocities;
    position_ = body.positions;
    step.mean_velocities.setZero(3, num_nodes);
    acceleration_sum_.setZero(3, num_nodes);

    // Stage s is evaluated at x0 + c_s h k_(s-1) and weighs b_s.
    constexpr double kFractions[] = {0.5, 0.5, 1.0};
    constexpr double kWeights[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    for (int stage = 0; stage < 4; ++stage) {
      const double time = stage == 0 ? 0.0 : kFractions[stage - 1] * time_step;
      dynamics.evaluate(position_, velocity_, time, BodyDynamics::VelocityLaws::kAsForces,
                        acceleration_);
      step.mean_velocities += kWeights[stage] * velocity_;
      acceleration_sum_ += kWeights[stage] * acceleration_;
      if (stage == 3) break;
      const double distance = kFractions[stage] * time_step;
      position_ = body.positions + distance * velocity_;
      velocity_ = body.velocities + distance * acceleration_;
    }
    step.end_velocities = body.velocities + time_step * acceleration_sum_;
  }

  void finish(BodyDynamics& /*dynamics*/, ConstMatrix3XRef<double> /*positions*/,
              double /*time_step*/, Matrix3X<double>& /*velocities*/) override {}

 private:
  Matrix3X<double> position_, velocity_;              // of the current stage [m], [m/s]
  Matrix3X<double> acceleration_, acceleration_sum_;  // [m/s^2]
};

}  // namespace

std::unique_ptr<Integrator> make_runge_kutta4() {
  return std::make_unique<RungeKutta4>();
}

}  // namespace weft::reference
