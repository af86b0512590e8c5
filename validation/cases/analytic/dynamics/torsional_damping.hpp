#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// Two rings twist against each other: the mode decays at the stated rate.
void check_torsional_mode(const CaseInfo& info, Report& report);

/// A ring of masses on springs spins 1000 turns with all internal damping on and loses nothing.
void check_spinning_ring(const CaseInfo& info, Report& report);

}  // namespace weft::validation
