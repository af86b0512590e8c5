#include <weft/validation/reference/integrators/integrator.hpp>

#include <weft/custom_forces/core/error.hpp>

namespace weft::reference {

std::unique_ptr<Integrator> make_integrator(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::kExplicitEuler:
      return make_explicit_euler();
    case IntegratorKind::kModifiedEuler:
      return make_modified_euler();
    case IntegratorKind::kVelocityVerlet:
      return make_velocity_verlet();
    case IntegratorKind::kRungeKutta4:
      return make_runge_kutta4();
  }
  throw InvalidArgument("reference solver: integrator = " + std::to_string(static_cast<int>(kind)) +
                        ", expected a value of IntegratorKind");
}

}  // namespace weft::reference
