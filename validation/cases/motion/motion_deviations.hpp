#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <span>

#include <weft/validation/cases/support/known_deviation.hpp>

namespace weft::validation {

/// Kndiscretization errors of the fast solver in motion, in contact and at rest (swing, impacts, rest), each with its figure. A row that
/// no longer holds fails its check and must be taken out.
[[nodiscard]] std::span<const MotionDeviation> motion_deviations();

inline constexpr const char* kMotionReason =
    "waves that an impact sends into the cloth are shorter than a substep, and the energy of a "
    "step in which a body is thrown "
    "back is that of its middle; rounding of many substeps adds up to momentum "
    "(docs/implicit_step.md)";

}  // namespace weft::validation
