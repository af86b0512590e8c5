#pragma once

// Tested by tests/viewer/window_test.py.

#include <weft/viewer/ui/panels/panels.hpp>

namespace weft::viewer {

/// Draws the forces of colliders on nodes as arrows over the picture, in the color of their friction, with a legend.
void draw_contacts(const PanelFrame& frame, const Snapshot& shown, const scenes::Camera& camera,
                   double aspect);

}  // namespace weft::viewer
