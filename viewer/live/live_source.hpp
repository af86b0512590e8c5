#pragma once

// Tested by tests/viewer/session_test.cpp.

#include <weft/viewer/live/simulation.hpp>
#include <weft/viewer/model/frames/source.hpp>
#include <weft/viewer/model/law_edit.hpp>

namespace weft::viewer {

struct LiveSettings {
  std::string name;         ///< catalog name or scene file
  std::string engine = {};  ///< empty: the first that the scene is made for
  std::string record = {};  ///< of the first run
  bool is_running = true;
  double speed = 1.0;
  scenes::Provenance provenance = {};
};

/// A scene that is simulated while it is looked at, and its laws as they are set now.
class LiveSource final : public Source {
 public:
  /// Throws as load_scene() and for an engine that is not there.
  explicit LiveSource(LiveSettings settings);

  [[nodiscard]] const scenes::Scene& drawn_scene() const override { return scene_; }
  [[nodiscard]] int version() const override { return version_; }
  [[nodiscard]] SnapshotPtr shown() override;
  void update(double seconds) override;
  bool perform(Action action) override;
  [[nodiscard]] std::string take_message() override;
  [[nodiscard]] bool is_playing() const override { return is_playing_; }
  [[nodiscard]] double speed() const override { return settings_.speed; }
  void set_speed(double speed) override;
  [[nodiscard]] int num_frames() const override;
  [[nodiscard]] int frame() const override;
  [[nodiscard]] double frame_time(int frame) const override;
  void seek(int frame) override;
  [[nodiscard]] std::vector<PlotPoint> plot() const override;
  void describe(nlohmann::json& json) const override;

  /// Reads the scene again and starts it. What cannot be read is told by the message, and all stays.
  void reload();
  void set_engine(const std::string& name);
  [[nodiscard]] const std::string& engine() const { return settings_.engine; }
  [[nodiscard]] std::vector<std::string> engines() const;
  /// A type of cloth_types(), for all cloths.
  void set_cloth_type(std::size_t type);
  [[nodiscard]] std::size_t cloth_type() const { return cloth_type_; }
  void set_parameter(const Parameter& parameter, double value);
  [[nodiscard]] Simulation& simulation() { return *simulation_; }

 private:
  void start(bool is_running);
  bool perform_time(Action action);
  bool perform_wind_or_gravity(Action action);
  void step(int direction);
  void send_laws();

  LiveSettings settings_;
  scenes::Scene written_;  ///< as the file has it, with the engine's time step
  scenes::Scene scene_;    ///< as it is set now
  std::unique_ptr<Simulation> simulation_;
  int version_ = 0;
  bool is_playing_;
  bool has_other_laws_ = false;  ///< than the file
  SnapshotPtr looked_back_;      ///< a kept frame that is shown in place of the newest state
  std::size_t cloth_type_ = 0;
  std::string message_;
};

}  // namespace weft::viewer
