// Tested by tests/reference/integrators_test.cpp.

#include <algorithm>
#include <array>
#include <cmath>

#include <weft/reference/integrators/integrator.hpp>

namespace weft::reference {
namespace {

constexpr int kStages = 7;
/// Dormand and Prince (1980), RK5(4)7M: times, stages, and order 5 minus order 4.
constexpr std::array<double, kStages> kTimes = {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1, 1};
constexpr double kStage[kStages][kStages - 1] = {
    {},
    {1. / 5},
    {3. / 40, 9. / 40},
    {44. / 45, -56. / 15, 32. / 9},
    {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
    {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
    {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
constexpr std::array<double, kStages> kError = {
    71. / 57600, 0, -71. / 16695, 71. / 1920, -17253. / 339200, 22. / 525, -1. / 40};

/// The method of order 5 of Dormand and Prince (1980), with as many inner steps as the error of its
/// embedded method of order 4 asks for: no node may err by more than relative x size of the body +
/// absolute in position, nor by more than relative x largest speed + absolute in velocity, in one
/// inner step. Velocity-level laws are forces like the others.
class DormandPrince5 final : public Integrator {
 public:
  explicit DormandPrince5(const IntegratorSettings& settings) : settings_(settings) {}

  [[nodiscard]] IntegratorKind kind() const override { return IntegratorKind::kDormandPrince5; }
  [[nodiscard]] int order() const override { return 5; }

  void advance(BodyDynamics& dynamics, double time_step, BodyStep& step) override {
    const Body& body = dynamics.body();
    moved_.setZero(3, body.positions.cols());
    velocity_ = body.velocities;
    step.report = {.inner_steps = 0};
    double time = 0.0;
    while (time < time_step) {
      const double left = time_step - time;
      const bool is_end = !(proposal_ > 0.0 && proposal_ < left);
      const double h = is_end ? left : proposal_;
      evaluate_stages(dynamics, time, h);
      const bool is_forced = step.report.inner_steps + step.report.rejected_steps >= kMaxInnerSteps;
      const double error = relative_error(body, h);
      // 0.9 and the bounds: the usual caution of step size control.
      const double factor = std::clamp(0.9 * std::pow(error, -0.2), 0.2, 5.0);
      if (!(error <= 1.0) && !is_forced) {
        ++step.report.rejected_steps;
        proposal_ = h * (std::isfinite(error) ? factor : 0.2);
        continue;
      }
      step.report.converged = step.report.converged && error <= 1.0;
      ++step.report.inner_steps;
      moved_ = stage_moved_;
      velocity_ = stage_velocity_;
      time = is_end ? time_step : time + h;
      // A step cut off by the end says nothing against the longer one that was planned.
      if (!is_end || factor * h > proposal_) proposal_ = factor * h;
      if (is_forced) {
        step.report.exhausted = "the error of a step is over its tolerance after 20000 inner steps";
        break;
      }
    }
    step.mean_velocities = moved_ / time_step;
    step.end_velocities = velocity_;
  }

 private:
  /// More than this within one step is an error that cannot be met: a blow-up.
  static constexpr int kMaxInnerSteps = 20000;

  /// All stages of an inner step; the last one is its result.
  void evaluate_stages(BodyDynamics& dynamics, double time, double h) {
    const Matrix3X<double>& start = dynamics.body().positions;
    for (int s = 0; s < kStages; ++s) {
      const auto stage = static_cast<std::size_t>(s);
      stage_moved_ = moved_;
      stage_velocity_ = velocity_;
      for (std::size_t r = 0; r < stage; ++r) {
        if (kStage[s][r] == 0.0) continue;
        stage_moved_ += h * kStage[s][r] * velocities_[r];
        stage_velocity_ += h * kStage[s][r] * accelerations_[r];
      }
      velocities_[stage] = stage_velocity_;
      accelerations_[stage].resize(3, start.cols());
      dynamics.evaluate(start + stage_moved_, stage_velocity_, time + kTimes[stage] * h,
                        BodyDynamics::VelocityLaws::kAsForces, accelerations_[stage]);
    }
  }

  /// Largest error of a node over what it may be.
  [[nodiscard]] double relative_error(const Body& body, double h) const {
    Matrix3X<double> position = Matrix3X<double>::Zero(3, body.positions.cols());
    Matrix3X<double> velocity = position;
    for (std::size_t s = 0; s < kStages; ++s) {
      position += h * kError[s] * velocities_[s];
      velocity += h * kError[s] * accelerations_[s];
    }
    const Vector3<double> extent =
        body.positions.rowwise().maxCoeff() - body.positions.rowwise().minCoeff();
    const double speed = std::sqrt(std::max(velocity_.colwise().squaredNorm().maxCoeff(),
                                            stage_velocity_.colwise().squaredNorm().maxCoeff()));
    const double error_x = std::sqrt(position.colwise().squaredNorm().maxCoeff());
    const double error_v = std::sqrt(velocity.colwise().squaredNorm().maxCoeff());
    const double relative = settings_.relative_tolerance;
    const double absolute = settings_.absolute_tolerance;
    return std::max(error_x / (relative * extent.norm() + absolute),
                    error_v / (relative * speed + absolute));
  }

  IntegratorSettings settings_;
  double proposal_ = 0.0;              // length of the next inner step [s]; 0: the whole step
  Matrix3X<double> moved_, velocity_;  // x - x0 [m], [m/s]
  Matrix3X<double> stage_moved_, stage_velocity_;  // of the stage that is made
  std::array<Matrix3X<double>, kStages> velocities_, accelerations_;
};

}  // namespace

std::unique_ptr<Integrator> make_dormand_prince5(const IntegratorSettings& settings) {
  return std::make_unique<DormandPrince5>(settings);
}

}  // namespace weft::reference
