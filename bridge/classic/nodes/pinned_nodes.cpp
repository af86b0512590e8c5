#include <weft/bridge/classic/nodes/pinned_nodes.hpp>

#include <string>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

void check(const std::vector<int>& nodes, ConstMatrix3XRef<double> targets,
           const btSoftBody& body) {
  if (targets.cols() != static_cast<Eigen::Index>(nodes.size())) {
    throw InvalidArgument("pinned nodes: " + std::to_string(targets.cols()) +
                          " targets, expected one for each of the " + std::to_string(nodes.size()) +
                          " nodes");
  }
  for (const int node : nodes) {
    if (node < 0 || node >= body.m_nodes.size()) {
      throw InvalidArgument("pinned nodes: node " + std::to_string(node) + ", expected 0 to " +
                            std::to_string(body.m_nodes.size() - 1));
    }
    if (body.m_nodes[node].m_im > 0) {
      throw InvalidArgument("pinned nodes: node " + std::to_string(node) +
                            " has a mass and can move, expected a pinned one");
    }
  }
}

}  // namespace

void move_kinematic_nodes(const std::vector<int>& nodes, ConstMatrix3XRef<double> targets,
                          double time_step, btSoftBody& body) {
  check(nodes, targets, body);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[nodes[i]];
    const Vector3<double> displacement =
        targets.col(static_cast<Eigen::Index>(i)) - from_bullet(node.m_x);
    node.m_v = to_bullet(displacement / time_step);
  }
}

void place_nodes(const std::vector<int>& nodes, ConstMatrix3XRef<double> targets, double time_step,
                 btSoftBody& body) {
  check(nodes, targets, body);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[nodes[i]];
    const Vector3<double> target = targets.col(static_cast<Eigen::Index>(i));
    node.m_v = to_bullet((target - from_bullet(node.m_q)) / time_step);
    node.m_x = to_bullet(target);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
