#include <weft/bridge/soft_world.hpp>

#include <vector>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

namespace {

// Bullet's distance field is a hash table of cells with 2383 lists by default; a scene with a dozen
// colliders and fine voxels has 100,000 cells, and each node would walk through half a list.
constexpr int kNumCellLists = 131071;
// Bullet forgets no cell by itself. A cell that nobody has asked for in so many steps is computed
// anew when it is needed: the same numbers, so that no bit depends on it.
constexpr int kStepsPerCollection = 1000;
constexpr int kCollectionsPerLife = 10;

}  // namespace

struct SoftWorld::Parts {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraint_solver;
  std::vector<std::shared_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> rigid_bodies;
  std::vector<std::unique_ptr<btSoftBody>> soft_bodies;
};

SoftWorld::SoftWorld(const SoftWorldSettings& settings)
    : parts_(std::make_unique<Parts>()), solver_(std::make_unique<SoftBodySolver>()) {
  world_ = std::make_unique<btSoftRigidDynamicsWorld>(&parts_->dispatcher, &parts_->broadphase,
                                                      &parts_->constraint_solver,
                                                      &parts_->configuration, solver_.get());
  const Vector3<btScalar> gravity = settings.gravity.cast<btScalar>();
  world_->setGravity(btVector3(gravity[0], gravity[1], gravity[2]));
  btSoftBodyWorldInfo& info = world_->getWorldInfo();
  info.m_gravity.setZero();
  info.air_density = 0;
  info.water_density = 0;
  info.water_offset = 0;
  info.water_normal.setZero();
  info.m_maxDisplacement = 1000;
  info.m_sparsesdf.Initialize(kNumCellLists);
  info.m_sparsesdf.setDefaultVoxelsz(static_cast<btScalar>(settings.distance_field_voxel));
  info.m_sparsesdf.Reset();
}

SoftWorld::~SoftWorld() {
  for (const auto& body : parts_->soft_bodies) world_->removeSoftBody(body.get());
  for (const auto& body : parts_->rigid_bodies) world_->removeRigidBody(body.get());
}

btSoftBody& SoftWorld::add(std::unique_ptr<btSoftBody> body) {
  world_->addSoftBody(body.get());
  parts_->soft_bodies.push_back(std::move(body));
  return *parts_->soft_bodies.back();
}

btRigidBody& SoftWorld::add(std::unique_ptr<btRigidBody> body,
                            std::shared_ptr<btCollisionShape> shape) {
  parts_->shapes.push_back(std::move(shape));
  world_->addRigidBody(body.get());
  parts_->rigid_bodies.push_back(std::move(body));
  return *parts_->rigid_bodies.back();
}

void SoftWorld::step(double time_step) {
  world_->stepSimulation(static_cast<btScalar>(time_step), 0);
  if (++num_steps_ % kStepsPerCollection != 0) return;
  world_->getWorldInfo().m_sparsesdf.GarbageCollect(kCollectionsPerLife);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
