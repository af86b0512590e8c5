// A Bullet program with soft bodies, as it may have stood for years. One line is new: the solver.
#include <cmath>
#include <cstdio>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <weft/bridge/adoption/adopting_solver.hpp>

int main() {
  weft::bridge::AdoptingSolver solver;  // the new line; before: none, or Bullet's default solver
  solver.set_on_adoption([](btSoftBody&, const weft::bridge::AdoptionReport& report) {
    std::printf("%s\n", report.text().c_str());
  });

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration, &solver);
  world.setGravity(btVector3(0, btScalar(-9.81), 0));
  world.getWorldInfo().m_gravity = world.getGravity();

  btBoxShape box(btVector3(1, 1, 1));
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, &box);
  info.m_startWorldTransform.setOrigin(btVector3(0, -1, 0));
  btRigidBody ground(info);
  world.addRigidBody(&ground);

  btSoftBody* const sheet = btSoftBodyHelpers::CreatePatch(
      world.getWorldInfo(), btVector3(-1.5, 0.5, -1.5), btVector3(1.5, 0.5, -1.5),
      btVector3(-1.5, 0.5, 1.5), btVector3(1.5, 0.5, 1.5), 31, 31, 0, true);
  sheet->m_cfg.kDF = 0.7F;
  sheet->m_cfg.piterations = 10;
  sheet->getCollisionShape()->setMargin(0.02F);
  sheet->generateBendingConstraints(2);
  sheet->setTotalMass(1);
  world.addSoftBody(sheet);

  for (int step = 0; step < 300; ++step) world.stepSimulation(1 / 60.0F, 0);

  const double center = static_cast<double>(sheet->m_nodes[15 * 31 + 15].m_x.y());
  const double corner = static_cast<double>(sheet->m_nodes[0].m_x.y());
  std::printf("the middle of the sheet lies at %.3f m, a corner hangs at %.3f m\n", center, corner);
  const bool is_right = std::abs(center - 0.02) < 1e-3 && corner < -0.3 && !solver.blow_up(*sheet);

  world.removeSoftBody(sheet);
  world.removeRigidBody(&ground);
  delete sheet;
  return is_right ? 0 : 1;
}
