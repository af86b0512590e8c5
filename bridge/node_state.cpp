#include <weft/bridge/node_state.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void read_nodes(const btSoftBody& body, Matrix3X<btScalar>& positions,
                Matrix3X<btScalar>& velocities) {
  const int num_nodes = body.m_nodes.size();
  positions.resize(3, num_nodes);
  velocities.resize(3, num_nodes);
  for (int i = 0; i < num_nodes; ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    positions.col(i) << node.m_x.x(), node.m_x.y(), node.m_x.z();
    velocities.col(i) << node.m_v.x(), node.m_v.y(), node.m_v.z();
  }
}

void add_node_forces(const Matrix3X<btScalar>& forces, btSoftBody& body) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    body.m_nodes[i].m_f += btVector3(forces(0, i), forces(1, i), forces(2, i));
  }
}

void write_node_velocities(const Matrix3X<btScalar>& velocities, btSoftBody& body) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im > 0) node.m_v.setValue(velocities(0, i), velocities(1, i), velocities(2, i));
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
