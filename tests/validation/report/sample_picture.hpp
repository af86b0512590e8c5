#pragma once

#include <string>

namespace weft::tests {

/// The bytes of a PNG of 320 x 240 pixels: a shaded cloth over a sphere. `sag` [1] bends it; 0 to 1
/// is sensible.
[[nodiscard]] std::string sample_png(double sag);

}  // namespace weft::tests
