#pragma once

// Tested by tests/recorder/recorder_test.cpp.

#include <string>

#include <weft/recorder/recorder.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {

/// The scene of a program's own loop, without bodies. Throws InvalidArgument for an interval that is none.
[[nodiscard]] scenes::Scene empty_scene(const RecorderOptions& options);

/// Throws InvalidArgument, which begins with `what`, if no reader would take this scene.
void require_readable(scenes::Scene scene, const std::string& what);

/// A view from the front, the right and above of everything but planes.
[[nodiscard]] scenes::Camera view_of(const scenes::Scene& scene, const scenes::SceneState& state);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
