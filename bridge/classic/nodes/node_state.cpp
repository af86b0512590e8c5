#include <weft/bridge/classic/nodes/node_state.hpp>

#include <string>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/core/parallel/parallel_for.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

namespace {

/// Nodes of a task: some 20 us, ten times what it takes another thread to find it.
constexpr std::size_t kTask = 2048;

template <class Work>
void for_nodes(int num_nodes, const Work& work) {
  const auto size = static_cast<std::size_t>(num_nodes);
  parallel_for(IndexRange{0, size}, size < 2 * kTask ? size : kTask, [&](IndexRange nodes) {
    work(fast::NodeRange{static_cast<int>(nodes.begin), static_cast<int>(nodes.end)});
  });
}

}  // namespace

void read_nodes(const btSoftBody& body, Matrix3X<btScalar>& positions,
                Matrix3X<btScalar>& velocities) {
  const int num_nodes = body.m_nodes.size();
  positions.resize(3, num_nodes);
  velocities.resize(3, num_nodes);
  for_nodes(num_nodes,
            [&](fast::NodeRange nodes) { read_nodes(body, nodes, positions, velocities); });
}

void read_nodes(const btSoftBody& body, fast::NodeRange nodes, Matrix3X<btScalar>& positions,
                Matrix3X<btScalar>& velocities) {
  for (int i = nodes.begin; i < nodes.end; ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    positions.col(i) << node.m_x.x(), node.m_x.y(), node.m_x.z();
    velocities.col(i) << node.m_v.x(), node.m_v.y(), node.m_v.z();
  }
}

void add_node_forces(const Matrix3X<btScalar>& forces, btSoftBody& body) {
  for_nodes(body.m_nodes.size(),
            [&](fast::NodeRange nodes) { add_node_forces(forces, nodes, body); });
}

void add_node_forces(const Matrix3X<btScalar>& forces, fast::NodeRange nodes, btSoftBody& body) {
  for (int i = nodes.begin; i < nodes.end; ++i) {
    body.m_nodes[i].m_f += btVector3(forces(0, i), forces(1, i), forces(2, i));
  }
}

void write_node_velocities(const Matrix3X<btScalar>& velocities, btSoftBody& body) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im > 0) node.m_v.setValue(velocities(0, i), velocities(1, i), velocities(2, i));
  }
}

void place_body(ConstMatrix3XRef<double> positions, ConstMatrix3XRef<double> velocities,
                btSoftBody& body) {
  for (const auto& [what, given] :
       {std::pair("positions", positions.cols()), std::pair("velocities", velocities.cols())}) {
    if (given == body.m_nodes.size()) continue;
    throw InvalidArgument("place body: " + std::to_string(given) + " " + what + ", expected " +
                          std::to_string(body.m_nodes.size()));
  }
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    const Vector3<btScalar> position = positions.col(i).cast<btScalar>();
    const Vector3<btScalar> velocity = velocities.col(i).cast<btScalar>();
    node.m_x.setValue(position[0], position[1], position[2]);
    node.m_q = node.m_x;
    node.m_v.setValue(velocity[0], velocity[1], velocity[2]);
    node.m_vn = node.m_v;
    node.m_f.setZero();
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
