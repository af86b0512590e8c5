#pragma once

// Tested by tests/bridge/classic/nodes/node_normals_test.cpp, tests/bridge/implicit/outside_changes_test.cpp.

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/mesh/position_limits.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Moves the nodes of a body that violate their limits to the allowed position, m_x, and adds the displacement
/// divided by time_step [s] to m_v, as Bullet derives velocities from positions. Pinned nodes stay.
/// Each node by itself: no order matters. Throws InvalidArgument for limits that do not fit the body.
void apply_position_limits(const PositionLimits& limits, double time_step, btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
