#pragma once

// Tested by tests/bridge/solver_checks_test.cpp.

#include <optional>
#include <string>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Why a body cannot be stepped by FastBody; nothing for one that can.
[[nodiscard]] std::optional<std::string> reason_against_implicit(const btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
