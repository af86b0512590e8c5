#pragma once

#include "tests/contract/measurement.hpp"
#include "tests/contract/subject.hpp"

namespace weft::contract {

/// advance_velocities is the exact solution of m dv/dt = f(x, v), x held: the difference to
/// fourth-order Runge-Kutta steps with add_forces falls as step^4.
[[nodiscard]] Measurement advance_solves_the_equation(const Subject& subject);

/// Two half steps are one step, so that the decay does not depend on the time step.
template <class Scalar>
[[nodiscard]] Measurement two_half_steps_are_one(const Subject& subject);

/// advance_velocities of a law of level kForce changes no bit.
template <class Scalar>
[[nodiscard]] Measurement advance_changes_nothing(const Subject& subject);

}  // namespace weft::contract
