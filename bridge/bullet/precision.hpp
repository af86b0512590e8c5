#pragma once

// Tested by tests/install/one_precision.cmake.

#include <LinearMath/btScalar.h>

// The bridge is built once for each precision of Bullet. Everything in it lives in an inline
// namespace named after the precision, so that a program compiled for one and linked to the other
// does not link.
#ifdef BT_USE_DOUBLE_PRECISION
#define WEFT_BULLET_PRECISION float64
static_assert(sizeof(btScalar) == 8,
              "BT_USE_DOUBLE_PRECISION is set, but btScalar is not a double");
#else
#define WEFT_BULLET_PRECISION float32
static_assert(sizeof(btScalar) == 4,
              "BT_USE_DOUBLE_PRECISION is not set, but btScalar is not a float");
#endif

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// "float32" or "float64".
[[nodiscard]] const char* precision_name();

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
