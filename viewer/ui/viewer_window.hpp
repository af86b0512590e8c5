#pragma once

// Tested by tests/viewer/window_test.py.

#include <memory>
#include <string>

#include <weft/viewer/model/script.hpp>
#include <weft/viewer/session.hpp>

namespace weft::viewer {

struct ViewerSettings {
  SessionSettings session;
  WindowSize size = kWindowSizes[2];
  double scale = 0.0;  ///< of text and panels; 0: as the screen asks for
  Script script = {};
  /// JSON to write at the end, and after a picture whenever the file is not there; empty: none
  std::string state_file = {};
  bool exits_at_end = false;  ///< once the scene's duration is simulated
};

/// Opens the window and returns when it is closed. Throws Error if there is none.
void run_viewer(ViewerSettings settings);

}  // namespace weft::viewer
