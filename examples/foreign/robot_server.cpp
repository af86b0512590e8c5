// After physics servers for robots (PyBullet's): a world of multibodies; cloth from arrays of a mesh file, and an arm that pushes it.
#include <array>
#include <memory>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "longest_stretch.hpp"
#ifdef WITH_WEFT
#include <weft/weft.hpp>
#endif

namespace {

constexpr int kSide = 15;

class Server {
 public:
  Server() {
#ifdef WITH_WEFT
    soft_body_solver_ = std::make_unique<weft::bridge::AdoptingSolver>();
#endif
    world_ = std::make_unique<btSoftMultiBodyDynamicsWorld>(
        &dispatcher_, &broadphase_, &solver_, &configuration_, soft_body_solver_.get());
    world_->setGravity(btVector3(0, 0, btScalar(-9.81)));
    world_->getWorldInfo().m_gravity = world_->getGravity();
    world_->getWorldInfo().m_sparsesdf.Initialize();
  }

  /// As loadSoftBody does: points and triangles of a mesh, mass, margin, friction.
  btSoftBody& load_soft_body(const std::vector<btScalar>& points, const std::vector<int>& triangles,
                             double mass) {
    soft_.reset(btSoftBodyHelpers::CreateFromTriMesh(
        world_->getWorldInfo(), points.data(), triangles.data(),
        static_cast<int>(triangles.size()) / 3, false));
    soft_->m_cfg.piterations = 20;
    soft_->m_cfg.kDF = btScalar(0.5);
    soft_->getCollisionShape()->setMargin(btScalar(0.01));
    soft_->setTotalMass(btScalar(mass));
    world_->addSoftBody(soft_.get());
    return *soft_;
  }
  /// A slider with a ball at its end.
  btMultiBody& load_arm() {
    arm_ = std::make_unique<btMultiBody>(1, btScalar(1), btVector3(1, 1, 1), true, false);
    arm_->setupPrismatic(0, btScalar(0.5), btVector3(1e-3F, 1e-3F, 1e-3F), -1,
                         btQuaternion::getIdentity(), btVector3(0, 1, 0),
                         btVector3(0, btScalar(-0.4), btScalar(0.4)), btVector3(0, 0, 0), true);
    arm_->finalizeMultiDof();
    world_->addMultiBody(arm_.get());
    tip_ = std::make_unique<btMultiBodyLinkCollider>(arm_.get(), 0);
    tip_->setCollisionShape(&ball_);
    arm_->getLink(0).m_collider = tip_.get();
    world_->addCollisionObject(tip_.get(), btBroadphaseProxy::DefaultFilter,
                               btBroadphaseProxy::AllFilter);
    return *arm_;
  }
  void step() {
    world_->stepSimulation(btScalar(1) / 120, 0);
  }
  ~Server() {
    if (arm_) world_->removeMultiBody(arm_.get());
    if (tip_) world_->removeCollisionObject(tip_.get());
    if (soft_) world_->removeSoftBody(soft_.get());
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  std::unique_ptr<btSoftBodySolver> soft_body_solver_;
  std::unique_ptr<btSoftMultiBodyDynamicsWorld> world_;
  btSphereShape ball_{btScalar(0.12)};
  std::unique_ptr<btMultiBody> arm_;
  std::unique_ptr<btMultiBodyLinkCollider> tip_;
  std::unique_ptr<btSoftBody> soft_;
};

}  // namespace

int main(int argc, char** argv) {
  Server server;
  // A square of 1 m that hangs in the plane y = 0, as a file has it.
  std::vector<btScalar> points;
  std::vector<int> triangles;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      points.insert(points.end(), {btScalar(column) / (kSide - 1) - btScalar(0.5), 0,
                                   1 - btScalar(row) / (kSide - 1)});
      if (row == 0 || column == 0) continue;
      const int corner = row * kSide + column;
      triangles.insert(triangles.end(), {corner, corner - 1, corner - kSide, corner - 1,
                                         corner - kSide - 1, corner - kSide});
    }
  }
  btSoftBody& cloth = server.load_soft_body(points, triangles, 0.2);
  for (const int corner : {0, kSide - 1}) cloth.setMass(corner, 0);
  btMultiBody& arm = server.load_arm();
  for (int step = 0; step < 120; ++step) server.step();
  for (int step = 0; step < 120; ++step) {
    arm.setJointVel(0, btScalar(0.6));
    server.step();
  }
  // The ball has gone 0.6 m and carries the middle of the cloth in front of it.
  const btVector3 middle = cloth.m_nodes[(kSide / 2 + 1) * kSide + kSide / 2].m_x;
  return end_with("an arm in a curtain", longest_stretch(cloth),
                  middle.y() > btScalar(0.1) && middle.y() < 1, argc, argv);
}
