#pragma once

// Tested by tests/playback/exchange/point_cache_export_test.cpp, tests/playback/exchange/gltf/gltf_export_test.cpp.

#include <weft/core/error.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// The recording has something that the files of another program cannot hold; the message does not name the recording.
class UnfitRecording : public Error {
 public:
  using Error::Error;
};

/// Throws UnfitRecording, with frame, time, node and body, for a position of a node or a pose of a rigid body that is not finite in
/// single precision, which is what the other programs compute in.
void check_finite(const SceneState& state, int frame);

}  // namespace weft::scenes
