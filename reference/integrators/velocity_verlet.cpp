// Tested by tests/reference/integrators_test.cpp.

#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// Velocity Verlet, with two additions that keep order 2 for every kind of damping:
///
///   u  = exact velocity-level laws over h/2 applied to v0       (first half of a Strang splitting)
///   a0 = a(x0, u)
///   x1 = x0 + h (u + h/2 a0)
///   a1 = a(x1, u + h a0)                                        (velocity predicted for
///   velocity-dependent forces) v1 = u + h/2 (a0 + a1), then velocity-level laws over h/2   (second
///   half, in finish())
///
/// The predicted velocity is off by O(h^2), so v1 is off by O(h^3) per step: order 2. Where no
/// force depends on velocity it has no effect and the scheme is plain, symplectic velocity Verlet.
class VelocityVerlet final : public Integrator {
 public:
  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kVelocityVerlet; }
  [[nodiscard]] int order() const override { return 2; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    constexpr auto kSeparate = BodyDynamics::VelocityLaws::kSeparate;
    const Body& body = dynamics.body();
    first_.resize(3, body.positions.cols());
    second_.resize(3, body.positions.cols());
    start_ = body.velocities;
    dynamics.advance_velocities(body.positions, 0.5 * time_step, start_);

    dynamics.evaluate(body.positions, start_, 0.0, kSeparate, first_);
    step.mean_velocities = start_ + 0.5 * time_step * first_;
    moved_ = body.positions + time_step * step.mean_velocities;
    predicted_ = start_ + time_step * first_;
    dynamics.evaluate(moved_, predicted_, time_step, kSeparate, second_);
    step.end_velocities = start_ + 0.5 * time_step * (first_ + second_);
  }

  void finish(BodyDynamics& dynamics, ConstMatrix3XRef<double> positions, double time_step,
              Matrix3X<double>& velocities) override {
    dynamics.advance_velocities(positions, 0.5 * time_step, velocities);
  }

 private:
  Matrix3X<double> start_, predicted_, moved_;  // u, u + h a0 [m/s]; x1 [m]
  Matrix3X<double> first_, second_;             // a0, a1 [m/s^2]
};

}  // namespace

std::unique_ptr<Integrator> make_velocity_verlet() {
  return std::make_unique<VelocityVerlet>();
}

}  // namespace weft::reference
