#pragma once

// Tested by tests/fast_solver/network/spring_network_test.cpp, tests/mesh/cutting/tear_test.cpp.

#include <cstddef>

namespace weft {

/// The index of a node, edge or face as containers of the standard library take it. i >= 0.
[[nodiscard]] constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace weft
