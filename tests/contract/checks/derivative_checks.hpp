#pragma once

#include "tests/contract/measurement.hpp"
#include "tests/contract/subject.hpp"

namespace weft::contract {

/// add_stiffness_product against (df/dx) b: by automatic differentiation to round-off, by central
/// differences with order 2.
[[nodiscard]] Measurement stiffness_is_the_derivative(const Subject& subject);
[[nodiscard]] Measurement stiffness_is_the_difference(const Subject& subject);

/// add_damping_product against (df/dv) b, likewise.
[[nodiscard]] Measurement damping_is_the_derivative(const Subject& subject);
[[nodiscard]] Measurement damping_is_the_difference(const Subject& subject);

/// a . (K b) = b . (K a) for a force that comes from an energy; v = 0.
[[nodiscard]] Measurement stiffness_is_symmetric(const Subject& subject);

/// The float law agrees with the double law: forces, both products, energy and power.
[[nodiscard]] Measurement float_agrees_with_double(const Subject& subject);

}  // namespace weft::contract
