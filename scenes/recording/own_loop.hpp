#pragma once

// Tested by tests/recorder/recorder_test.cpp.

#include <string_view>

namespace weft::scenes {

/// The "engine" in the provenance of a recording that a program made of its own world. Its scene
/// has no law, and a duration and a time step that nobody has asked for.
inline constexpr std::string_view kOwnLoop = "a program's own loop";

}  // namespace weft::scenes
