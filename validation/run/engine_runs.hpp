#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::validation {

/// One simulation that a validation case needs.
struct RunRequest {
  std::string label;  ///< unique; names the files, "hang_bullet_forces_float64"
  scenes::Scene scene;
  std::string engine;
  scenes::StoredPrecision precision = scenes::StoredPrecision::kFloat64;
  int threads = 1;  ///< of the force laws; runs go side by side, so one each is fastest
};

/// Runs simulations as processes of the weft command, several at a time: Bullet's two precisions
/// cannot live in one process, and a crash of an engine is a result and not the end of the report.
class EngineRuns {
 public:
  /// weft: the command's executable. folder: where scenes, recordings and logs go; it is created.
  EngineRuns(std::filesystem::path weft, std::filesystem::path folder, int jobs);

  /// Adds a run. A second request with the same label is the same run.
  void add(const RunRequest& request);
  /// Adds the outcome of a run that somebody else has done: nothing is run for it.
  void add_recording(const std::string& label, const std::filesystem::path& recording);

  /// Runs everything that was added and not run yet. progress: fraction done, 0 to 1.
  void run_all(const std::function<void(double fraction, const std::string& label)>& progress);

  struct Outcome {
    int exit_code =
        -1;           ///< of weft run: 0 ok, 1 blew up, 2 bad input; 128 + n if signal n ended it
    std::string log;  ///< what it printed
    std::filesystem::path recording;  ///< exists for exit codes 0 and 1
    /// Wall time of the engine's steps alone [s], as the run printed it.
    std::optional<double> engine_seconds = std::nullopt;
    /// Steps that were not solved to the tolerance over all [1], of an engine that iterates.
    std::optional<double> unsolved_share = std::nullopt;
  };
  /// Throws InvalidArgument for a label that was never added or not run.
  [[nodiscard]] const Outcome& outcome(const std::string& label) const;

 private:
  struct Run {
    RunRequest request;
    Outcome outcome;
    bool done = false;
  };
  [[nodiscard]] std::vector<std::string> command(const Run& run) const;
  int start(const Run& run) const;
  void finish(Run& run, int wait_status) const;

  std::filesystem::path weft_;
  std::filesystem::path folder_;
  int jobs_;
  std::vector<Run> runs_;
};

}  // namespace weft::validation
