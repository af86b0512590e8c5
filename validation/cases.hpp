#pragma once

// Tested by tests/validation/cases/scenes/scene_bounds_test.cpp, tests/validation/cases/support/parameters_test.cpp.

#include <span>

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// Every validation case, in the order of the report. A new case is one file under cases/ and one
/// row here.
[[nodiscard]] std::span<const CaseInfo> all_cases();

}  // namespace weft::validation
