// Which node touches what, and who is told when something goes wrong.
#include <cmath>
#include <cstdio>
#include <memory>

#include <btBulletDynamicsCommon.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>

int main() {
  weft::bridge::SoftWorld world({});
  auto shape = std::make_shared<btSphereShape>(btScalar(0.3));
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape.get());
  info.m_friction = 1;
  btRigidBody& ball = world.add(std::make_unique<btRigidBody>(info), shape);

  const weft::ClothMesh mesh = weft::make_cloth_grid(
      {.nodes = {31, 31}, .size = {1.0, 1.0}, .center = {0, 0.4, 0}, .total_mass = 0.2});
  btSoftBody& cloth =
      world.add(weft::bridge::make_cloth_body(world.info(), mesh, {.collision_margin = 0.01}));
  weft::bridge::SoftBodySolver& solver = world.solver();
  const auto refusal = solver.attach_fast(cloth, mesh,
                                          {{"tension", {}, {{"stiffness", {200.0}}}},
                                           {"gravity", {}, {{"acceleration", {0, -9.81, 0}}}}});
  if (refusal) {
    std::fprintf(stderr, "%s\n", refusal->c_str());
    return 2;
  }
  for (int step = 0; step < 180; ++step) world.step(1 / 60.0);

  int num_touching = 0;
  bool is_right = true;
  for (const weft::bridge::NodeContact& contact : solver.rigid_contacts(cloth)) {
    if (contact.distance > btScalar(1e-4)) continue;  // near, but not touching
    ++num_touching;
    const btVector3 out = cloth.m_nodes[contact.node].m_x.normalized();
    is_right = is_right && contact.object == &ball && contact.normal.dot(out) > btScalar(0.99);
  }
  std::printf("%d of %d nodes touch the ball\n", num_touching, cloth.m_nodes.size());

  // A program's mistake: one node gets the speed of a meteorite.
  int blown_up_node = -1;
  solver.set_on_blow_up([&](btSoftBody&, const weft::bridge::BodyBlowUp& blow_up) {
    blown_up_node = blow_up.node;
    std::printf("node %d: %s\n", blow_up.node, blow_up.reason.c_str());
  });
  cloth.m_nodes[480].m_v = btVector3(btScalar(1e9), 0, 0);
  world.step(1 / 60.0);
  return is_right && num_touching > 50 && blown_up_node == 480 ? 0 : 1;
}
