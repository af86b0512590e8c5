// Tested by tests/reference/integrators_test.cpp.

#include <cmath>

#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

/// Three symmetric steps of order 2, forward, back and forward (Yoshida 1990): order 4.
///
///   S(h) = kick(h/2) drift(h) kick(h/2),  step = S(w1 h) S(w0 h) S(w1 h)
///   w1 = 1 / (2 - 2^(1/3)), w0 = 1 - 2 w1
///
/// drift moves positions with fixed velocities. kick changes velocities at fixed positions, by the
/// implicit midpoint rule: u = v + h a(x, (v + u) / 2), so that S stays symmetric, and the order 4,
/// where forces depend on velocities. Where they do not, kick is v + h a(x) and the method is
/// symplectic. Velocity-level laws are forces like the others.
class Yoshida4 final : public Integrator {
 public:
  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kYoshida4; }
  [[nodiscard]] int order() const override { return 4; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    const Body& body = dynamics.body();
    const double outer = 1.0 / (2.0 - std::cbrt(2.0));
    velocity_ = body.velocities;
    moved_.setZero(3, body.positions.cols());
    step.report = {};
    double time = 0.0;
    for (const double weight : {outer, 1.0 - 2.0 * outer, outer}) {
      const double h = weight * time_step;
      kick(dynamics, 0.5 * h, time, step.report);
      moved_ += h * velocity_;
      time += h;
      kick(dynamics, 0.5 * h, time, step.report);
    }
    step.mean_velocities = moved_ / time_step;
    step.end_velocities = velocity_;
  }

 private:
  /// Fixed points: each iteration shrinks the error by h c / 2, so this is far more than any stable
  /// step needs.
  static constexpr int kMaxIterations = 200;
  static constexpr double kTolerance = 4e-16;  // two roundings of the largest velocity

  void kick(BodyDynamics& dynamics, double h, double time, IntegrationReport& report) {
    constexpr auto kAsForces = BodyDynamics::VelocityLaws::kAsForces;
    const Matrix3X<double> position = dynamics.body().positions + moved_;
    acceleration_.resize(3, position.cols());
    const Matrix3X<double> start = velocity_;
    Matrix3X<double> middle = start;
    double change = 0.0;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      dynamics.evaluate(position, middle, time, kAsForces, acceleration_);
      const Matrix3X<double> next = start + 0.5 * h * acceleration_;
      change = (next - middle).cwiseAbs().maxCoeff();
      middle = next;
      // Without velocities in the forces the second evaluation gives the same bits.
      if (iteration > 0 && !(change > kTolerance * middle.cwiseAbs().maxCoeff())) break;
    }
    report.converged = report.converged && change <= kSlack * middle.cwiseAbs().maxCoeff();
    velocity_ = start + h * acceleration_;
  }
  /// What counts as converged, in case rounding keeps the last bits moving [-].
  static constexpr double kSlack = 1e-13;

  Matrix3X<double> velocity_, moved_, acceleration_;  // [m/s], x - x0 [m], [m/s^2]
};

}  // namespace

std::unique_ptr<Integrator> make_yoshida4() {
  return std::make_unique<Yoshida4>();
}

}  // namespace weft::reference
