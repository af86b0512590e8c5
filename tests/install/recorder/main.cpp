#include <cstdio>
#include <memory>
#include <vector>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <weft/recorder/recorder.hpp>

static_assert(sizeof(btScalar) == sizeof(EXPECTED_SCALAR),
              "the recorder brings Bullet's precision");

// A cloth falls on a ball in a world of Bullet alone.
int main() {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration);
  world.getWorldInfo().m_sparsesdf.Initialize();

  const std::unique_ptr<btSoftBody> cloth(btSoftBodyHelpers::CreatePatch(
      world.getWorldInfo(), btVector3(-1, 1, -1), btVector3(1, 1, -1), btVector3(-1, 1, 1),
      btVector3(1, 1, 1), 9, 9, 0, true));
  btSphereShape sphere(btScalar(0.5));
  btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &sphere));
  world.addSoftBody(cloth.get());
  world.addRigidBody(&ball);

  weft::recorder::Recorder recorder("fall.weftrec", {.name = "fall", .may_replace = true});
  recorder.add(*cloth, "cloth");
  recorder.add(ball, "ball");
  for (int step = 1; step <= 60; ++step) {
    world.stepSimulation(btScalar(1) / 60, 0);
    recorder.begin_frame(step / 60.0);
    std::vector<btVector3> touching;
    std::vector<btVector3> ways;  // within a tenth of a second
    for (int i = 0; i < cloth->m_nodes.size(); ++i) {
      const btSoftBody::Node& node = cloth->m_nodes[i];
      if (node.m_x.length() > btScalar(0.85)) continue;
      touching.push_back(node.m_x);
      ways.push_back(btScalar(0.1) * node.m_v);
    }
    recorder.log_points("near", touching);
    recorder.log_arrows("velocity", touching, ways);
    if (step == 30) recorder.event("half of the time is over");
    recorder.end_frame();
  }
  std::printf("%d frames, content hash %s\n", recorder.num_frames(), recorder.finish().c_str());
  world.removeRigidBody(&ball);
  world.removeSoftBody(cloth.get());
  return recorder.num_frames() == 60 ? 0 : 1;
}
