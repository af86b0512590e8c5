#pragma once

#include "tests/contract/measurement.hpp"
#include "tests/contract/subject.hpp"

namespace weft::contract {

/// force(x, v = 0) = -grad E: central differences of E, whose error must fall as h^2.
[[nodiscard]] Measurement force_is_minus_energy_gradient(const Subject& subject);

/// A law without energy returns exactly 0 [J].
[[nodiscard]] Measurement energy_is_zero(const Subject& subject);

/// f . v = -dE/dt + P_nc to round-off, dE/dt by automatic differentiation along v.
[[nodiscard]] Measurement power_is_accounted_for(const Subject& subject);

/// The largest P_nc over random states; none may be positive.
[[nodiscard]] Measurement power_is_never_positive(const Subject& subject);

}  // namespace weft::contract
