#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <cstdint>
#include <functional>
#include <string>

namespace weft::import {

/// What work may take beyond what this process has already.
struct IsolationBudget {
  std::uint64_t seconds = 60;                     ///< [s] of processor time, >= 1
  std::uint64_t bytes = std::uint64_t{4} << 30U;  ///< [bytes] of address space
};

/// Runs work in a process of its own and gives what it returns: whatever a damaged file makes a
/// library do there, this process goes on. Throws Error with the reason if work throws, crashes,
/// needs more than the budget.
[[nodiscard]] std::string run_isolated(const std::function<std::string()>& work,
                                       const IsolationBudget& budget = {});

}  // namespace weft::import
