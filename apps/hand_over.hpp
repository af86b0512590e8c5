#pragma once

#include <weft/scenes/recording/recording.hpp>

#include "apps/app.hpp"

namespace weft::app {

/// Executables of the weft command: "weft" holds Bullet's single-precision engines, "weft-float64"
/// the others.
[[nodiscard]] std::filesystem::path executable_for(const CommandLine& command_line,
                                                   scenes::StoredPrecision precision);

/// Starts the executable that holds Bullet's other precision in this process's place, with the same
/// words. Returns only by throwing Error, if there is no such executable.
[[noreturn]] void hand_over(const CommandLine& command_line, scenes::StoredPrecision precision);

}  // namespace weft::app
