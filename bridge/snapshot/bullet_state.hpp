#pragma once

// Tested by tests/bridge/snapshot_test.cpp.

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/core/types.hpp>

// State of Bullet's own objects between two steps.
namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// One vector of each node of a body (3 x number of nodes).
template <btVector3 btSoftBody::Node::*kVector>
[[nodiscard]] Matrix3X<btScalar> vectors_of(const btSoftBody& body) {
  Matrix3X<btScalar> vectors(3, body.m_nodes.size());
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    vectors.col(i) = from_bullet<btScalar>(body.m_nodes[i].*kVector);
  }
  return vectors;
}

void serialize(StateArchive& archive, btVector3& vector);
void serialize(StateArchive& archive, btTransform& transform);

/// Throws Error for an object whose state Bullet does not let one save: links of multibodies, and soft bodies with
/// clusters or a pose to match.
void check_savable(const btCollisionObject& object, int number);

/// Pose, motion and sleep of a rigid body, or the pose of another object that is no soft body.
void serialize(StateArchive& archive, btCollisionObject& object);
/// Nodes, bounds and sleep. keeps_starts: m_q counts too, which the next step else sets.
void serialize(StateArchive& archive, bool keeps_starts, btSoftBody& body);

/// Makes the trees of nodes and faces anew, in the order of these, so that what they find has no history.
void rebuild_trees(bool has_face_tree, btSoftBody& body);
/// Takes every object out of the broadphase and puts it back, in the order of the world, with the bounds that it had: pairs of
/// objects have an order without history then. Contact points between rigid bodies are forgotten; the next step finds them.
void rebuild_broadphase(StateArchive& archive, btSoftRigidDynamicsWorld& world);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
