#pragma once

// Tested by tests/scenes/recording/mark_test.cpp.

#include <string>
#include <string_view>

#include <weft/scenes/appearance/mark.hpp>

namespace weft::scenes {

/// "points", "lines" or "arrows".
[[nodiscard]] std::string_view mark_word(MarkKind kind);

/// Throws InvalidArgument, which names the mark, for another number of ends than of beginnings, and
/// for an empty name.
void check_mark(const Mark& mark);

/// A sentence of a program about one moment, as "the gripper lets go".
struct Note {
  double time = 0.0;  ///< [s]
  std::string text;
};

}  // namespace weft::scenes
