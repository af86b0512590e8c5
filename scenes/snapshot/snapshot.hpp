#pragma once

// Tested by tests/engines/snapshot_test.cpp, tests/scenes/snapshot/snapshot_file_test.cpp.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace weft::scenes {

/// A run between two steps: what an engine needs to go on with the same bits.
struct Snapshot {
  std::string engine;     ///< "bullet_weft"
  std::string precision;  ///< "float32", "float64"
  int step = 0;           ///< steps taken
  double time = 0.0;      ///< [s] of the engine
  /// As write_scene() gives it, of the scene that was loaded, without duration and frames. Snapshots of one run share it.
  std::shared_ptr<const std::string> scene;
  std::vector<std::byte> state;

  /// [bytes] Without the scene.
  [[nodiscard]] std::size_t size() const { return state.size(); }
};

/// The interface of engines whose runs can be saved and gone on with, beside Simulator.
class Resumable {
 public:
  virtual ~Resumable() = default;

  /// The present state, after load() or a step. Going on gives the same bits as coming back does.
  /// Caches whose order depends on how they were filled are made anew for that, in this run too.
  /// Throws Error for what a snapshot cannot have; the run can go on then.
  [[nodiscard]] virtual Snapshot save() = 0;

  /// Goes back, or on, to a snapshot of the same scene and engine, in whatever process it was taken.
  /// Controllers of the program (Simulator::set_controllers()) must be those that it had. Throws Error
  /// for another scene, engine or precision, and for damage; the scene has to be loaded again then.
  virtual void restore(const Snapshot& snapshot) = 0;
};

}  // namespace weft::scenes
