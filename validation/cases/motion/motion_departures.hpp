#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <span>

#include <weft/validation/cases/support/stated_departure.hpp>

namespace weft::validation {

/// What the fast solver is known to do wrong in motion, in contact and at rest (swing, impacts, rest): each row with its figure. A row that no longer
/// holds fails its check and must be taken out.
[[nodiscard]] std::span<const MotionDeparture> motion_departures();

inline constexpr const char* kMotionReason =
    "an unconverged step is drawn back towards its start or has its velocity taken, and contact "
    "with what moves is not solved with "
    "the cloth (docs/fast_solver.md)";

}  // namespace weft::validation
