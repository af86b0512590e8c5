#pragma once

#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// For each face of a body whose faces enclose a volume, in one piece: 1 if the normal of its winding leads out of the body, -1 if
/// it leads into it. Empty for any other body, which has no inside. Faces may be wound in any way.
[[nodiscard]] std::vector<signed char> outward_faces(const btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
