#pragma once

// Tested by tests/characters/skinning_test.cpp.

#include <string>
#include <vector>

namespace weft::characters {

/// Throws InvalidArgument "unknown bone 'spine', expected one of 'Hips', 'Spine'"; names without
/// letters are left out, and what is more than twenty is counted.
[[noreturn]] void refuse_name(const std::string& what, const std::string& name,
                              const std::vector<std::string>& names);

}  // namespace weft::characters
