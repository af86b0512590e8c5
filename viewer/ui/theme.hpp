#pragma once

// Tested by tests/viewer/window_test.py.

namespace weft::viewer {

/// Font, colors and sizes of the panels at a scale [-]; may be called again for another one.
void apply_theme(double scale);

}  // namespace weft::viewer
