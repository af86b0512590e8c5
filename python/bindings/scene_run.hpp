#pragma once

// Tested by tests/python/test_scene.py.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::python {

namespace py = pybind11;

/// How a scene is to be run.
struct RunRequest {
  std::string engine;
  scenes::StoredPrecision precision = scenes::StoredPrecision::kFloat64;
  std::function<std::unique_ptr<scenes::Simulator>()> make;
  std::filesystem::path output;  ///< recording to write
  bool may_replace = false;
  std::optional<double> duration = std::nullopt;   ///< [s] in place of the scene's
  std::optional<double> time_step = std::nullopt;  ///< [s] likewise
};

/// Runs and records a scene as `weft run` does, without the lock of the interpreter; returns what came of it as a dict. Python's
/// signals are looked at every 50 ms: what they raise (KeyboardInterrupt) ends the run, and its frames stay in the partial
/// recording. Throws as record_run() and RecordingOutput.
[[nodiscard]] py::dict run_scene(const scenes::Scene& scene, const RunRequest& request);

/// The step, the time [s], the body, the node and the reason of a blow-up as a dict; None if there is none.
[[nodiscard]] py::object blow_up_dict(const std::optional<scenes::BlowUp>& blow_up);

}  // namespace weft::python
