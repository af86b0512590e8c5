#pragma once

#include <functional>
#include <string>

namespace weft::import {

/// Runs work in a process of its own and gives what it returns: whatever a damaged file makes a
/// library do there, this process goes on. Throws Error with the reason if work throws, crashes,
/// needs more than a minute of processor time or more than 4 GiB of memory.
[[nodiscard]] std::string run_isolated(const std::function<std::string()>& work);

}  // namespace weft::import
