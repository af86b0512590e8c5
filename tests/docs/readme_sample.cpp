// The sample of README.md, compiled and run. The region between the marks stands there to the
// letter.
#include <cstdio>
#include <memory>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/solver.hpp>

int main() {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;

  // README sample
  weft::bridge::SoftBodySolver solver;  // nothing attached: Bullet, bit for bit
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration, &solver);
  world.getWorldInfo().m_gravity.setZero();  // the cloth has a gravity law of its own

  const weft::ClothMesh mesh = weft::make_cloth_grid(
      {.nodes = {25, 25}, .size = {1.0, 1.0}, .total_mass = 0.25});  // [m], [kg]
  const auto cloth = weft::bridge::make_cloth_body(world.getWorldInfo(), mesh, {});
  world.addSoftBody(cloth.get());

  solver.attach(*cloth, mesh,
                {{"tension", {}, {{"stiffness", {60.0}}}},              // [N/m]
                 {"gravity", {}, {{"acceleration", {0, -9.81, 0}}}}});  // [m/s^2]
  for (int step = 0; step < 100; ++step) world.stepSimulation(1 / 2000.0, 0);
  const double fallen = -static_cast<double>(cloth->m_nodes[0].m_x.y());  // [m]
  world.removeSoftBody(cloth.get());
  // README sample end

  std::printf("fell %.4f m in 0.05 s\n", fallen);
  // Symplectic Euler: g h^2 n (n + 1) / 2 = 0.01239 m, to single precision.
  return fallen > 0.01238 && fallen < 0.01240 ? 0 : 1;
}
