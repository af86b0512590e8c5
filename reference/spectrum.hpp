#pragma once

// Tested by tests/reference/damping_test.cpp.

#include <weft/custom_forces/spectrum.hpp>
#include <weft/reference/system.hpp>

namespace weft::reference {

using forces::Spectrum;

/// The spectrum of a body at its present state.
[[nodiscard]] Spectrum spectrum(Body& body);

}  // namespace weft::reference
