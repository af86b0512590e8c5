#pragma once

// Tested by tests/viewer/session_test.cpp.

#include <weft/viewer/model/frames/source.hpp>
#include <weft/viewer/recorded/comparison.hpp>

namespace weft::viewer {

/// Recordings with a clock.
class RecordedSource final : public Source {
 public:
  explicit RecordedSource(const std::vector<std::filesystem::path>& paths);

  [[nodiscard]] const scenes::Scene& drawn_scene() const override;
  [[nodiscard]] int version() const override { return version_; }
  [[nodiscard]] SnapshotPtr shown() override { return comparison_.frame(frame_); }
  [[nodiscard]] std::optional<scenes::Ghosts> ghosts() const override;
  [[nodiscard]] std::vector<ShownRecording> recordings() const override;
  void update(double seconds) override;
  bool perform(Action action) override;
  [[nodiscard]] std::string take_message() override;
  [[nodiscard]] bool is_playing() const override { return is_playing_; }
  [[nodiscard]] double speed() const override { return speed_; }
  void set_speed(double speed) override { speed_ = speed; }
  [[nodiscard]] int num_frames() const override { return comparison_.num_frames(); }
  [[nodiscard]] int frame() const override { return frame_; }
  [[nodiscard]] double frame_time(int frame) const override;
  void seek(int frame) override;
  [[nodiscard]] std::vector<scenes::Note> notes() const override { return comparison_.notes(); }
  [[nodiscard]] std::vector<PlotPoint> plot() const override;
  void describe(nlohmann::json& json) const override;

 private:
  void rebuilt();
  void follow(double seconds);

  Comparison comparison_;
  int version_ = 0;
  bool is_playing_ = false;
  bool is_looping_ = true;
  double speed_ = 1.0;
  double time_ = 0.0;  ///< [s]
  int frame_ = 0;
  double look_age_ = 0.0;       ///< [s] since the last look at files that grow
  double look_interval_ = 0.0;  ///< [s]
  std::string message_;
};

}  // namespace weft::viewer
