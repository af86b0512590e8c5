#pragma once

// Tested by tests/viewer/live/simulation_test.cpp.

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include <weft/scenes/snapshot/snapshot_ring.hpp>
#include <weft/viewer/live/run_recorder.hpp>
#include <weft/viewer/live/simulation.hpp>
#include <weft/viewer/live/step_parts.hpp>
#include <weft/viewer/model/frames/frame_ring.hpp>

namespace weft::viewer {

/// The thread behind Simulation, and what it shares with the window's thread.
class Simulation::Worker {
 public:
  explicit Worker(SimulationSettings settings);
  ~Worker();

  /// For the thread of the window: a change before the next step.
  void ask(std::function<void()> change);
  template <class Result>
  Result read(const std::function<Result(Worker&)>& get) {
    const std::lock_guard lock(mutex_);
    return get(*this);
  }

  // Shared, under mutex_.
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<std::function<void()>> changes_;
  bool is_quitting_ = false;
  FrameRing ring_;
  SnapshotPtr latest_;
  std::optional<std::string> failure_;
  std::string unfinished_;  ///< path of a recording that is under way
  std::string refusal_;
  bool reached_end_ = false;

  // The simulation's thread alone changes these, when it is asked to.
  bool is_running_;
  double speed_;
  int wanted_steps_ = 0;
  void set_laws(std::size_t cloth, const std::vector<forces::LawSpecification>& laws);
  /// The state before the last single step.
  void take_back();
  void forget_steps() { rollback_.clear(); }
  void begin_pace() { pace_start_.reset(); }

  const SimulationSettings settings_;
  const std::shared_ptr<WindowForces> forces_;

 private:
  void run();
  void simulate();
  /// Waits for leave to step; false to quit.
  bool wait();
  void step();
  void publish(bool is_frame);
  void record_frame(bool is_last);
  /// Before a single step. A run that nobody steps by hand is not touched.
  void save();
  void refuse(const std::string& why);

  std::unique_ptr<scenes::Simulator> simulator_;
  std::unique_ptr<RunRecorder> recorder_;
  scenes::SnapshotRing rollback_{kRollbackBytes};
  Meter meter_;
  scenes::Scene measured_scene_;
  StepParts parts_;
  int num_parts_ = 1;  ///< of the last step
  int step_ = 0;       ///< whole steps so far
  scenes::StepReport report_;
  double step_time_ = 0.0;  ///< [s]
  long steps_per_frame_ = 1;
  long num_steps_ = 0;  ///< of the scene's duration
  std::chrono::steady_clock::time_point published_{};
  std::optional<std::chrono::steady_clock::time_point> pace_start_;
  double pace_time_ = 0.0;  ///< [s] simulated at pace_start_
  std::thread thread_;      // last: it uses all of the above
};

}  // namespace weft::viewer
