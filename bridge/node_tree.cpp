#include <weft/bridge/node_tree.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

// The tree's depth is some 20; one that has degenerated to a list is left to Bullet.
constexpr int kMostDepth = 200;

void refit(btDbvtNode* node, int depth) {
  if (node->isleaf() || depth > kMostDepth) return;
  refit(node->childs[0], depth + 1);
  refit(node->childs[1], depth + 1);
  Merge(node->childs[0]->volume, node->childs[1]->volume, node->volume);
}

}  // namespace

void cover_motion(btSoftBody& body, ConstMatrix3XRef<btScalar> velocities,
                  ConstMatrix3XRef<btScalar> last_velocities, btScalar time_step) {
  if (body.m_ndbvt.m_root == nullptr) return;
  const bool has_last = last_velocities.cols() == velocities.cols();
  const btScalar margin = body.getCollisionShape()->getMargin();
  // Bullet asks for three steps of motion and the margin.
  const btScalar ahead = (kCoveredSteps + 3) * time_step;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    const btVector3 motion =
        ahead * btVector3(velocities(0, i), velocities(1, i), velocities(2, i));
    btVector3 low = node.m_x;
    btVector3 high = node.m_x;
    low.setMin(node.m_x + motion);
    high.setMax(node.m_x + motion);
    btVector3 extra(margin, margin, margin);
    if (has_last) {
      const Vector3<btScalar> change = velocities.col(i) - last_velocities.col(i);
      extra += ahead * kCoveredSteps * btVector3(change[0], change[1], change[2]).absolute();
    }
    node.m_leaf->volume = btDbvtVolume::FromMM(low - extra, high + extra);
  }
  refit(body.m_ndbvt.m_root, 0);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
