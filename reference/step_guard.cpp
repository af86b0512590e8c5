#include <weft/reference/step_guard.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <weft/core/error.hpp>

namespace weft::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// a / b, infinite for b = 0.
double ratio(double a, double b) {
  return b > 0.0 ? a / b : kInfinity;
}

double verlet_step(const Spectrum& s) {
  // Positive root of h^2 w^2 + 2 h f = 4, in the form that stays exact for w -> 0.
  const double f = s.gamma_force_max;
  return ratio(4.0, f + std::hypot(f, 2.0 * s.omega_max));
}

double runge_kutta_step(const Spectrum& s) {
  const double damping = s.gamma_force_max + s.gamma_velocity_max;
  if (damping == 0.0) return ratio(kRungeKuttaImaginary, s.omega_max);
  return ratio(kRungeKuttaHalfDisc, std::max(s.omega_max, damping));
}

double yoshida_step(const Spectrum& s) {
  const double damping = s.gamma_force_max + s.gamma_velocity_max;
  if (damping == 0.0) return ratio(kYoshidaUndamped, s.omega_max);
  return ratio(kYoshidaDamped, std::max(s.omega_max, damping));
}

double explicit_euler_step(const Spectrum& s) {
  const double oscillation = ratio(s.top_mode_damping, s.omega_max * s.omega_max);
  return std::min(oscillation, ratio(2.0, s.gamma_force_max + s.gamma_velocity_max));
}

}  // namespace

double stable_step(IntegratorKind integrator, const Spectrum& spectrum) {
  switch (integrator) {
    case IntegratorKind::kExplicitEuler:
      return explicit_euler_step(spectrum);
    case IntegratorKind::kModifiedEuler:
      return forces::critical_time_step(spectrum);
    case IntegratorKind::kVelocityVerlet:
      return verlet_step(spectrum);
    case IntegratorKind::kRungeKutta4:
      return runge_kutta_step(spectrum);
    case IntegratorKind::kYoshida4:
      return yoshida_step(spectrum);
    case IntegratorKind::kDormandPrince5:
    case IntegratorKind::kImplicitEuler:
    case IntegratorKind::kTrBdf2:
    case IntegratorKind::kImplicitMidpoint:
    case IntegratorKind::kGeneralizedAlpha:
      return kInfinity;
  }
  throw InvalidArgument(
      "reference solver: integrator = " + std::to_string(static_cast<int>(integrator)) +
      ", expected a value of IntegratorKind");
}

Stability assess(System& system, IntegratorKind integrator) {
  Stability least{.stable_step = kInfinity, .body = {}, .spectrum = {}};
  for (Body& body : system.bodies) {
    const Spectrum found = spectrum(body);
    const double step = stable_step(integrator, found);
    if (least.body.empty() || step < least.stable_step) least = {step, body.name, found};
  }
  return least;
}

int num_substeps(GuardPolicy policy, const Stability& stability, double time_step) {
  const double limit = stability.stable_step;
  const auto refuse = [&](const std::string& expected) {
    std::ostringstream message;
    message << "reference solver, cloth '" << stability.body << "': time_step = " << time_step
            << " [s], expected " << expected << " " << limit << " [s]";
    throw InvalidArgument(message.str());
  };
  if (policy == GuardPolicy::kRefuse && !(time_step < limit)) refuse("less than the stable step");
  if (policy != GuardPolicy::kSubstep) return 1;
  const double needed = std::ceil(time_step / (kSubstepSafety * limit));
  if (!(needed <= kMaxSubsteps)) {
    std::ostringstream expected;
    expected << "at most " << kMaxSubsteps << " substeps of " << kSubstepSafety
             << " times the stable step,";
    refuse(expected.str());
  }
  return std::max(1, static_cast<int>(needed));
}

}  // namespace weft::reference
