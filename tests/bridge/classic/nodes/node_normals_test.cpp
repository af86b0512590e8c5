#include <weft/bridge/classic/nodes/node_normals.hpp>

#include <cmath>
#include <utility>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

struct Normals {
  std::vector<btVector3> of_nodes;
  std::vector<btVector3> of_faces;
};

Normals normals_of(const btSoftBody& body) {
  Normals normals;
  for (int i = 0; i < body.m_nodes.size(); ++i) normals.of_nodes.push_back(body.m_nodes[i].m_n);
  for (int f = 0; f < body.m_faces.size(); ++f)
    normals.of_faces.push_back(body.m_faces[f].m_normal);
  return normals;
}

/// The number of those that are not Bullet's, to the bit.
int num_others(const btSoftBody& body, const Normals& normals) {
  const Normals bullets = normals_of(body);
  const auto differ = [](const std::vector<btVector3>& a, const std::vector<btVector3>& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += a[i] == b[i] ? 0 : 1;
    return count;
  };
  return differ(normals.of_nodes, bullets.of_nodes) + differ(normals.of_faces, bullets.of_faces);
}

void crumple(btSoftBody& body) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const auto k = static_cast<btScalar>(i);
    body.m_nodes[i].m_x +=
        btScalar(0.05) * btVector3(std::sin(k), std::cos(btScalar(1.7) * k), std::sin(3 * k));
  }
}

TEST(NodeNormals, AreThoseOfBullet) {
  Scene scene(cloth(40, 1, 1), {law("tension", "stiffness", 300)});
  btSoftBody& body = scene.body();
  NodeNormals normals;
  fast::WorkerTeam team;
  const fast::WorkerTeam::Scope scope(team, 2);
  const auto num_wrong = [&] {
    normals.update(body, team);
    const Normals ours = normals_of(body);
    body.updateNormals();
    return num_others(body, ours);
  };
  crumple(body);
  EXPECT_EQ(num_wrong(), 0);
  crumple(body);
  EXPECT_EQ(num_wrong(), 0);
  // As a cut does: other corners, fewer faces, and a face that has no area.
  std::swap(body.m_faces[7].m_n[0], body.m_faces[2000].m_n[2]);
  EXPECT_EQ(num_wrong(), 0);
  body.m_faces.resize(body.m_faces.size() - 100);
  EXPECT_EQ(num_wrong(), 0);
  body.m_faces[3].m_n[1] = body.m_faces[3].m_n[0];
  EXPECT_EQ(num_wrong(), 0);
  // The comparison can fail.
  normals.update(body, team);
  Normals changed = normals_of(body);
  changed.of_nodes[5].setX(changed.of_nodes[5].x() + btScalar(1e-6));
  EXPECT_EQ(num_others(body, changed), 1);
}

/// What a step leaves is of the places at its end.
int num_wrong_after(Scene& scene, int num_steps) {
  int wrong = 0;
  for (int step = 0; step < num_steps; ++step) {
    scene.step();
    const Normals ours = normals_of(scene.body());
    scene.body().updateNormals();
    wrong += num_others(scene.body(), ours);
  }
  return wrong;
}

TEST(NodeNormals, AreUpToDateAfterAStep) {
  Scene scene(cloth(50, 1, 0.05), {kGravity, law("tension", "stiffness", 300)});
  scene.add(box(1, 0.5, 1), 0, at(0, -0.5, 0));
  EXPECT_EQ(num_wrong_after(scene, 20), 0);
  // Limits move nodes after the solution.
  PositionLimits limits;
  limits.centers = scene.positions().array() + 0.02;
  limits.max_distances = VectorX<double>::Constant(limits.centers.cols(), 0.01);
  scene.solver().set_position_limits(scene.body(), limits);
  EXPECT_EQ(num_wrong_after(scene, 5), 0);
}

/// A single fast body, and below it one with other solver, whose contacts move the first one's nodes after its own.
TEST(NodeNormals, AreUpToDateWhereAnotherClothPushes) {
  Scene scene(cloth(20, 1, 0.06), {kGravity, law("tension", "stiffness", 300)});
  SoftWorld& world = scene.world();
  const ClothMesh other = cloth(20, 1, 0.03);
  btSoftBody& below =
      world.add(make_cloth_body(world.info(), other, {.collision_margin = kMargin}));
  world.solver().attach(below, other, {kGravity, law("tension", "stiffness", 300)});
  for (btSoftBody* body : {&scene.body(), &below}) {
    world.solver().set_cloth_contact(*body, {.with_itself = false, .with_others = true});
  }
  scene.add(box(1, 0.5, 1), 0, at(0, -0.5, 0));
  EXPECT_EQ(num_wrong_after(scene, 20), 0);
  EXPECT_GT(scene.solver().num_contacts(scene.body()), 100);
}

TEST(NodeNormals, AreUpToDateWhereClothMeetsItself) {
  ClothMesh mesh = cloth(20, 1, 0);
  mesh.pinned = {0, 19};
  Scene scene(mesh, {kGravity, law("tension", "stiffness", 300)});
  scene.solver().set_cloth_contact(scene.body(), {.with_itself = true, .with_others = false});
  for (int i = 0; i < scene.body().m_nodes.size(); ++i) {  // folded over
    btVector3& x = scene.body().m_nodes[i].m_x;
    if (x.z() > 0) x.setValue(x.x(), btScalar(0.015), -x.z());
  }
  EXPECT_EQ(num_wrong_after(scene, 20), 0);
}

}  // namespace
}  // namespace weft::bridge
