#pragma once

// Tested by tests/bridge/implicit/fast_body_anchor_test.cpp, tests/bridge/rigid/multibody_test.cpp.

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// A node that an object leads.
struct NodeAnchor {
  int node = 0;
  const btCollisionObject* object = nullptr;  ///< a rigid body or a link of a multibody
  btVector3 local{0, 0, 0};                   ///< in the object's frame [m]
};

/// visit(anchor) for each of appendAnchor(), and for each of appendDeformableAnchor(), which takes links of multibodies and
/// which Bullet's classic world does not look at.
template <class Visit>
void for_anchors(const btSoftBody& body, const Visit& visit) {
  const auto number = [&](const btSoftBody::Node* node) {
    return static_cast<int>(node - &body.m_nodes[0]);
  };
  for (int a = 0; a < body.m_anchors.size(); ++a) {
    const btSoftBody::Anchor& anchor = body.m_anchors[a];
    visit(NodeAnchor{number(anchor.m_node), anchor.m_body, anchor.m_local});
  }
  for (int a = 0; a < body.m_deformableAnchors.size(); ++a) {
    const btSoftBody::DeformableNodeRigidAnchor& anchor = body.m_deformableAnchors[a];
    visit(NodeAnchor{number(anchor.m_node), anchor.m_cti.m_colObj, anchor.m_local});
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
