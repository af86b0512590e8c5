#pragma once

// Tested by tests/bridge/classic/damping_place_test.cpp, tests/bridge/implicit/fast_body_test.cpp.

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/types.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Node positions m_x, 3 x n [m], and velocities m_v, 3 x n [m/s]. The matrices are resized if
/// needed.
void read_nodes(const btSoftBody& body, Matrix3X<btScalar>& positions,
                Matrix3X<btScalar>& velocities);

/// The same for some nodes; the matrices have their size.
void read_nodes(const btSoftBody& body, fast::NodeRange nodes, Matrix3X<btScalar>& positions,
                Matrix3X<btScalar>& velocities);

/// Node forces m_f += forces, 3 x n [N].
void add_node_forces(const Matrix3X<btScalar>& forces, btSoftBody& body);
void add_node_forces(const Matrix3X<btScalar>& forces, fast::NodeRange nodes, btSoftBody& body);

/// Node velocities m_v = velocities, 3 x n [m/s]; pinned nodes (m_im = 0) keep theirs.
void write_node_velocities(const Matrix3X<btScalar>& velocities, btSoftBody& body);

/// Puts all nodes of a body that is not stepped to positions, 3 x n [m], with velocities, 3 x n
/// [m/s]; pinned nodes too. Nothing of what they did before is left.
void place_body(ConstMatrix3XRef<double> positions, ConstMatrix3XRef<double> velocities,
                btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
