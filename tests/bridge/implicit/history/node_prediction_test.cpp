#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/implicit/history/node_prediction.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

bool is_equal(const btVector3& a, const btVector3& b) {
  return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

/// Boxes of a tree that do not hold those below them.
int num_too_small(const btDbvtNode* node) {
  if (node->isleaf()) return 0;
  int count = 0;
  for (const btDbvtNode* child : node->childs) {
    count += node->volume.Contain(child->volume) ? num_too_small(child) : 1;
  }
  return count;
}

/// A cloth with a pin that moves in some way, forces, and gravity of Bullet's.
class MovedCloth {
 public:
  MovedCloth() : scene_(mesh(), {law("tension", "stiffness", 300)}) {
    btSoftBody& body = scene_.body();
    body.m_worldInfo->m_gravity = btVector3(0, -3, 0);
    body.m_worldInfo->m_maxDisplacement =
        btScalar(0.05);  // of which the largest force reaches more
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      const auto k = static_cast<btScalar>(i);
      body.m_nodes[i].m_v.setValue(std::sin(k), std::cos(2 * k), btScalar(0.1) * k);
      body.m_nodes[i].m_f.setValue(btScalar(0.01) * k, -std::sin(3 * k), std::cos(k));
    }
  }
  [[nodiscard]] btSoftBody& body() { return scene_.body(); }

 private:
  static ClothMesh mesh() {
    ClothMesh mesh = cloth(40, 1, 1);  // three parts for threads
    mesh.pinned = {0, 3};
    return mesh;
  }
  Scene scene_;
};

TEST(NodePrediction, MovesNodesAsBulletDoes) {
  MovedCloth ours;
  MovedCloth bullets;
  ASSERT_TRUE(is_plain(ours.body()));
  const auto step = static_cast<btScalar>(kTimeStep);
  fast::WorkerTeam team;
  const fast::WorkerTeam::Scope scope(team, 2);
  for (int k = 0; k < 5; ++k) {
    std::vector<int> scratch;
    predict_nodes(ours.body(), step, Matrix3X<btScalar>(3, 0), true, scratch, team);
    bullets.body().predictMotion(step);
    for (int i = 0; i < ours.body().m_nodes.size(); ++i) {
      const btSoftBody::Node& a = ours.body().m_nodes[i];
      const btSoftBody::Node& b = bullets.body().m_nodes[i];
      ASSERT_TRUE(is_equal(a.m_x, b.m_x) && is_equal(a.m_q, b.m_q)) << i;
      ASSERT_TRUE(is_equal(a.m_v, b.m_v) && is_equal(a.m_f, b.m_f)) << i;
      ASSERT_TRUE(
          a.m_leaf->volume.Contain(btDbvtVolume::FromCR(a.m_x, static_cast<btScalar>(kMargin))))
          << i;
    }
    EXPECT_EQ(num_too_small(ours.body().m_ndbvt.m_root), 0);
    EXPECT_EQ(ours.body().m_sst.sdt, bullets.body().m_sst.sdt);
    EXPECT_EQ(ours.body().m_sst.velmrg, bullets.body().m_sst.velmrg);
    // Bullet's bounds hold where nodes will be, ours where they are too.
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(ours.body().m_bounds[0][axis], bullets.body().m_bounds[0][axis]);
      EXPECT_GE(ours.body().m_bounds[1][axis], bullets.body().m_bounds[1][axis]);
    }
  }
}

TEST(NodePrediction, LeavesToBulletWhatIsNotPlain) {
  MovedCloth cloth;
  cloth.body().m_bUpdateRtCst = true;
  EXPECT_FALSE(is_plain(cloth.body()));
  cloth.body().m_bUpdateRtCst = false;
  EXPECT_TRUE(is_plain(cloth.body()));
  cloth.body().m_cfg.kPR = 1;
  EXPECT_FALSE(is_plain(cloth.body()));
  cloth.body().m_cfg.kPR = 0;
  cloth.body().m_pose.m_bframe = true;
  EXPECT_FALSE(is_plain(cloth.body()));
}

// What Bullet's own collision, and every user of the tree, relies on.
TEST(NodePrediction, KeepsEachBoxOfTheTreeInTheNextOne) {
  Scene scene(cloth(12, 1, 1), {kGravity, law("tension", "stiffness", 300)});
  scene.set_velocity(btVector3(3, 1, 0));
  scene.add(std::make_shared<btSphereShape>(btScalar(0.3)), 0, at(0.2, -0.3, 0));
  for (int step = 0; step < 40; ++step) {
    scene.step(1);
    for (int i = 0; i < scene.body().m_nodes.size(); ++i) {
      for (const btDbvtNode* box = scene.body().m_nodes[i].m_leaf; box->parent != nullptr;
           box = box->parent) {
        ASSERT_TRUE(box->parent->volume.Contain(box->volume)) << i;
      }
    }
  }
}

}  // namespace
}  // namespace weft::bridge
