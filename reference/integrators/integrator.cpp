#include <weft/reference/integrators/integrator.hpp>

#include <algorithm>
#include <sstream>

#include <weft/core/error.hpp>

namespace weft::reference {

namespace {

void check(const char* name, double value, bool is_valid, const char* expected) {
  if (is_valid) return;
  std::ostringstream message;
  message << "reference solver: " << name << " = " << value << ", expected " << expected;
  throw InvalidArgument(message.str());
}

}  // namespace

IntegrationReport combined(const IntegrationReport& first, const IntegrationReport& second) {
  return {.inner_steps = first.inner_steps + second.inner_steps,
          .rejected_steps = first.rejected_steps + second.rejected_steps,
          .newton_iterations = first.newton_iterations + second.newton_iterations,
          .residual = std::max(first.residual, second.residual),
          .converged = first.converged && second.converged,
          .exhausted = first.exhausted ? first.exhausted : second.exhausted};
}

std::unique_ptr<Integrator> make_integrator(IntegratorKind kind,
                                            const IntegratorSettings& settings) {
  const auto is_tolerance = [](double value) { return value > 0.0 && value < 1e300; };
  check("relative_tolerance [-]", settings.relative_tolerance,
        is_tolerance(settings.relative_tolerance), "> 0 and finite");
  check("absolute_tolerance [m], [m/s]", settings.absolute_tolerance,
        is_tolerance(settings.absolute_tolerance), "> 0 and finite");
  check("spectral_radius [-]", settings.spectral_radius,
        settings.spectral_radius >= 0.0 && settings.spectral_radius <= 1.0, "0 to 1");
  switch (kind) {
    case IntegratorKind::kExplicitEuler:
      return make_explicit_euler();
    case IntegratorKind::kModifiedEuler:
      return make_modified_euler();
    case IntegratorKind::kVelocityVerlet:
      return make_velocity_verlet();
    case IntegratorKind::kRungeKutta4:
      return make_runge_kutta4();
    case IntegratorKind::kYoshida4:
      return make_yoshida4();
    case IntegratorKind::kDormandPrince5:
      return make_dormand_prince5(settings);
    case IntegratorKind::kImplicitEuler:
      return make_implicit_euler();
    case IntegratorKind::kTrBdf2:
      return make_tr_bdf2();
    case IntegratorKind::kImplicitMidpoint:
      return make_implicit_midpoint();
    case IntegratorKind::kGeneralizedAlpha:
      return make_generalized_alpha(settings.spectral_radius);
  }
  throw InvalidArgument("reference solver: integrator = " + std::to_string(static_cast<int>(kind)) +
                        ", expected a value of IntegratorKind");
}

}  // namespace weft::reference
