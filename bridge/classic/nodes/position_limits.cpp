#include <weft/bridge/classic/nodes/position_limits.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void apply_position_limits(const PositionLimits& limits, double time_step, btSoftBody& body) {
  check_position_limits(limits, body.m_nodes.size());
  if (limits.is_empty()) return;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im == 0) continue;
    const Vector3<double> position =
        Vector3<btScalar>(node.m_x.x(), node.m_x.y(), node.m_x.z()).cast<double>();
    const Vector3<double> allowed = limited_position(limits, i, position);
    if (allowed == position) continue;
    const Vector3<btScalar> target = allowed.cast<btScalar>();
    const Vector3<btScalar> change = ((allowed - position) / time_step).cast<btScalar>();
    node.m_x.setValue(target[0], target[1], target[2]);
    node.m_v += btVector3(change[0], change[1], change[2]);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
