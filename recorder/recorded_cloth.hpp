#pragma once

// Tested by tests/recorder/recorder_test.cpp.

#include <string>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {

/// A soft body as a cloth of a scene: a mesh of its faces at the positions that the nodes have now,
/// with the mass, pins, margin and friction of the body. The mass is shared out by area or evenly,
/// whichever is nearer to the body's; a pinned node, which has no mass in Bullet, counts like the
/// others. Throws InvalidArgument if the faces make no surface.
[[nodiscard]] scenes::Cloth recorded_cloth(const btSoftBody& body, const std::string& name);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
