#pragma once

// Tested by tests/viewer/model/frames/frame_ring_test.cpp, tests/viewer/live/simulation_test.cpp.

#include <memory>
#include <optional>
#include <vector>

#include <weft/scenes/appearance/mark.hpp>
#include <weft/scenes/contact_view.hpp>
#include <weft/scenes/simulator.hpp>
#include <weft/viewer/model/measures.hpp>

namespace weft::viewer {

/// A state as the window shows it. Never changes once it is made, so that threads share it.
struct Snapshot {
  scenes::SceneState state;
  Measures measures;
  int step = 0;             ///< of a live run; number of the frame of a recording
  int num_parts = 1;        ///< into which the last step was divided
  double step_time = 0.0;   ///< [s] wall time that a step took lately; 0 for a recording
  double pull_force = 0.0;  ///< [N] with which the mouse pulls
  /// Of the last step; none: the engine, or a recording, does not tell.
  std::optional<std::vector<scenes::NodeTouch>> touches;
  std::vector<scenes::Mark> marks;  ///< of a program that has recorded its own loop
  std::optional<scenes::BlowUp> blow_up;
};

using SnapshotPtr = std::shared_ptr<const Snapshot>;

}  // namespace weft::viewer
