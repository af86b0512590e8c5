#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/precision.hpp>
#include <weft/custom_forces/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Steps for which cover_motion() looks ahead.
inline constexpr int kCoveredSteps = 4;

/// Before btSoftBody::predictMotion: grows the boxes of the tree of nodes so that they hold the way of
/// each node for the next kCoveredSteps steps, as far as velocities (3 x n [m/s]) and their changes in
/// the last step tell. Bullet then has nothing to do there: it takes a node whose box is too small out of the
/// tree and puts it back in, which for a cloth that moves is a quarter of a fast step. Neighbours in a
/// cloth stay neighbours, so that the tree stays good.
void cover_motion(btSoftBody& body, ConstMatrix3XRef<btScalar> velocities,
                  ConstMatrix3XRef<btScalar> last_velocities, btScalar time_step);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
