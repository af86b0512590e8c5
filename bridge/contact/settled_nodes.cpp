#include <weft/bridge/contact/settled_nodes.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void SettledNodes::find(const btSoftBody& body, std::span<const RigidContact> contacts,
                        const Collider& collider) {
  flags_.clear();
  const auto is_dynamic = [](const RigidContact& contact) { return contact.is_dynamic; };
  if (!is_still_solid(collider) || std::any_of(contacts.begin(), contacts.end(), is_dynamic)) {
    return;
  }
  const btScalar margin = body.getCollisionShape()->getMargin();
  flags_.resize(static_cast<std::size_t>(body.m_nodes.size()), 0);
  for (const RigidContact& contact : contacts) {
    if (contact.collider != collider.number) continue;
    const btSoftBody::Node& node = body.m_nodes[contact.node];
    const btScalar gap = btDot(contact.normal, node.m_x) - contact.offset;
    const bool is_near = (node.m_x - node.m_q).length2() <= margin * margin;
    if (is_near && gap >= -kDepthShare * margin) {
      flags_[static_cast<std::size_t>(contact.node)] = 1;
    }
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
