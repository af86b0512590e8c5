#pragma once

#include <array>
#include <string_view>

#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// Names of the cameras that every scene has: its own, along an axis, and from above a corner.
inline constexpr std::array<std::string_view, 8> kCameraPresets = {
    "scene", "front", "back", "left", "right", "top", "bottom", "iso"};

/// A camera that sees the whole scene at rest. "front" looks along -z, "right" along -x from the side where x is largest, "top" down, with x to the right in the
/// picture; "iso" from (1, 1, 1). Field of view and the followed body are those of the scene's camera. aspect_ratio: width / height.
/// Throws InvalidArgument for another name.
[[nodiscard]] Camera preset_camera(const Scene& scene, std::string_view preset,
                                   double aspect_ratio);

/// The camera after a turn about the vertical line through its target, to the right [rad].
[[nodiscard]] Camera turned_camera(const Camera& camera, double angle);

}  // namespace weft::scenes
