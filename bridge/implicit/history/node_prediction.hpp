#pragma once

#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/types.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Whether Bullet's own air or pressure acts on a body: these need normals.
[[nodiscard]] bool has_air(const btSoftBody::Config& settings);

/// Whether predict_nodes() is enough for a body: its constants are up to date, and it has neither clusters nor a frame
/// that its pose is matched to, nor Bullet's own air and pressure.
[[nodiscard]] bool is_plain(const btSoftBody& body);

/// btSoftBody::predictMotion for a plain body, to the same bits of m_x, m_q, m_v and m_f, in one pass over its nodes.
/// The broadphase is not told; m_bounds hold where nodes are and where they will be.
///
/// Boxes of the tree of nodes hold what Bullet's would. A node that has left its own is put into the tree anew, as
/// Bullet does it; if many have, all boxes grow to the swept bounds of the next steps instead, which costs less by far:
/// neighbors in a cloth stay neighbors, so that the tree stays good.
/// last_velocities: at the start of the step before, 3 x n [m/s], or of another size if not known: how fast paths bend.
/// keeps_tree: off, the tree of nodes stays as it is; one that has been left so for a while can be kept again at any time.
/// By a team, with the same bits for any. scratch: memory that is kept from step to step.
void predict_nodes(btSoftBody& body, btScalar time_step, ConstMatrix3XRef<btScalar> last_velocities,
                   bool keeps_tree, std::vector<int>& scratch, fast::WorkerTeam& team);

/// Tells the broadphase of m_bounds, after the prediction of a body.
void publish_bounds(btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
