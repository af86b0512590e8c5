// After engines that wrap Bullet in classes of their own (Panda3D, Godot's former module): a flag on a pole, in Bullet's wind.
#include <memory>

#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "longest_stretch.hpp"
#ifdef WITH_WEFT
#include <weft/weft.hpp>
#endif

namespace engine {

class PhysicsWorld {
 public:
  PhysicsWorld()
      : configuration_(std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>()),
        dispatcher_(std::make_unique<btCollisionDispatcher>(configuration_.get())),
        broadphase_(std::make_unique<btDbvtBroadphase>()),
        solver_(std::make_unique<btSequentialImpulseConstraintSolver>()) {
#ifdef WITH_WEFT
    soft_body_solver_ = std::make_unique<weft::bridge::AdoptingSolver>();
#endif
    world_ = std::make_unique<btSoftRigidDynamicsWorld>(dispatcher_.get(), broadphase_.get(),
                                                        solver_.get(), configuration_.get(),
                                                        soft_body_solver_.get());
  }
  void set_gravity(const btVector3& gravity) {
    world_->setGravity(gravity);
    world_->getWorldInfo().m_gravity = gravity;
  }
  void set_wind(const btVector3& velocity) {
    for (int b = 0; b < world_->getSoftBodyArray().size(); ++b)
      world_->getSoftBodyArray()[b]->setWindVelocity(velocity);
  }
  void do_physics(double seconds, int most_substeps, double substep) {
    world_->stepSimulation(btScalar(seconds), most_substeps, btScalar(substep));
  }
  [[nodiscard]] btSoftRigidDynamicsWorld& bullet() {
    return *world_;
  }

 private:
  std::unique_ptr<btSoftBodyRigidBodyCollisionConfiguration> configuration_;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  std::unique_ptr<btDbvtBroadphase> broadphase_;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
  std::unique_ptr<btSoftBodySolver> soft_body_solver_;  // none: the world makes one
  std::unique_ptr<btSoftRigidDynamicsWorld> world_;
};

}  // namespace engine

int main(int argc, char** argv) {
  engine::PhysicsWorld world;
  world.set_gravity(btVector3(0, btScalar(-9.81), 0));
  btCylinderShape shape(btVector3(btScalar(0.05), 2, btScalar(0.05)));
  btRigidBody pole(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape));
  world.bullet().addRigidBody(&pole);

  btSoftBody* const flag = btSoftBodyHelpers::CreatePatch(
      world.bullet().getWorldInfo(), btVector3(btScalar(0.1), 1, 0), btVector3(btScalar(1.6), 1, 0),
      btVector3(btScalar(0.1), 2, 0), btVector3(btScalar(1.6), 2, 0), 16, 11, 0, true);
  flag->setTotalMass(btScalar(0.3));
  flag->m_cfg.piterations = 5;
  flag->m_cfg.aeromodel = btSoftBody::eAeroModel::V_TwoSided;
  flag->m_cfg.kLF = btScalar(0.05);
  flag->m_cfg.kDG = btScalar(0.01);
  for (int row = 0; row < 11; ++row) flag->appendAnchor(row * 16, &pole, true);
  world.bullet().addSoftBody(flag);
  world.set_wind(btVector3(8, 0, 1));

  for (int frame = 0; frame < 240; ++frame) world.do_physics(1 / 50.0, 4, 1 / 60.0);
  const double stretch = longest_stretch(*flag);
  const btVector3 held = flag->m_nodes[0].m_x;
  const bool is_in_place = (held - btVector3(btScalar(0.1), 1, 0)).length() < btScalar(0.1);
  world.bullet().removeSoftBody(flag);
  world.bullet().removeRigidBody(&pole);
  delete flag;
  return end_with("a flag on a pole", stretch, is_in_place, argc, argv);
}
