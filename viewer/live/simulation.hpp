#pragma once

// Tested by tests/viewer/live/simulation_test.cpp.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <weft/engines/engine_table.hpp>
#include <weft/viewer/live/pull.hpp>
#include <weft/viewer/model/frames/snapshot.hpp>

namespace weft::viewer {

struct SimulationSettings {
  scenes::Scene scene;
  const scenes::EngineInfo* engine = nullptr;
  bool is_running = true;
  bool has_other_laws = false;  ///< than those that the scene's time step is made for
  double speed = 1.0;           ///< simulated over wall time, at most
  std::string record = {};      ///< a recording of the scene's duration to write; empty: none
  scenes::Provenance provenance = {};

  /// Whether the engine takes forces from outside: Bullet's deformable world does not.
  [[nodiscard]] bool takes_forces() const;
};

/// A scene that an engine simulates on a thread of its own. The picture never waits for a step: it takes
/// the last snapshot that is ready. As long as nobody changes laws or pulls, the states are those of
/// `weft run`, bit for bit.
class Simulation {
 public:
  /// Starts the thread, which loads the scene. Throws for a recording that cannot be written.
  explicit Simulation(SimulationSettings settings);
  /// Waits for the step that is under way.
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  void set_running(bool is_running);
  void set_speed(double speed);
  /// One step while it is paused.
  void step_once();
  /// While it is paused: the state before the last step_once() again, and so on for all that were taken since it was paused,
  /// as far as their states fit into kRollbackBytes. Refused while a recording is written and by engines without snapshots.
  void take_back();
  static constexpr std::size_t kRollbackBytes = std::size_t{256} * 1024 * 1024;
  /// Other laws from the next step on.
  void set_laws(std::size_t cloth, std::vector<forces::LawSpecification> laws);
  /// The gravity of rigid bodies [m/s^2]; that of cloth is a law.
  void set_gravity(const Vector3<double>& acceleration);
  void set_pull(const std::optional<Pull>& pull);
  void set_carry(const std::optional<Carry>& carry);

  /// The newest state; none before the scene is loaded.
  [[nodiscard]] SnapshotPtr latest() const;
  /// The frames that are kept, oldest first.
  [[nodiscard]] std::vector<SnapshotPtr> frames() const;
  [[nodiscard]] std::size_t num_frames() const;
  [[nodiscard]] SnapshotPtr frame(std::size_t index) const;

  /// Why the run cannot go on (the engine refuses the scene, the recording cannot be written).
  [[nodiscard]] std::optional<std::string> failure() const;
  /// The engine's refusals since the last call, else empty.
  [[nodiscard]] std::string take_refusal();
  /// Whether the scene's duration has been simulated, and recorded if that was asked for.
  [[nodiscard]] bool reached_end() const;
  /// The file of a recording that has not reached the scene's duration; empty: there is none.
  [[nodiscard]] std::string unfinished_recording() const;
  /// [N] that no pull on a cloth exceeds.
  [[nodiscard]] double largest_pull(std::size_t cloth) const;
  /// Whether the mouse can pull: some engines take no forces from outside.
  [[nodiscard]] bool can_pull() const;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace weft::viewer
