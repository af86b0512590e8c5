#pragma once

// Tested by tests/bridge/implicit/outside_changes_test.cpp.

#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Moves pinned nodes (mass 0 in Bullet) to given positions without a lag: move_kinematic_nodes() before the
/// step, place_nodes() after it. The contacts and springs of the step see them arrive.

/// Gives the nodes the velocities that bring them to targets, 3 x nodes.size() [m], within
/// time_step [s].
void move_kinematic_nodes(const std::vector<int>& nodes, ConstMatrix3XRef<double> targets,
                          double time_step, btSoftBody& body);

/// Puts the nodes where they were led: Bullet got there up to rounding, this is exact. They keep
/// the velocity that led them.
void place_nodes(const std::vector<int>& nodes, ConstMatrix3XRef<double> targets, double time_step,
                 btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
