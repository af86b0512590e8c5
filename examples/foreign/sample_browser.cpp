// After the scenes of Bullet's own example browser: boxes that fall on a sheet held by its corners.
#include <memory>
#include <vector>

#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "longest_stretch.hpp"
#ifdef WITH_WEFT
#include <weft/weft.hpp>
#endif

class SheetDemo {
 public:
  SheetDemo() {
    world_.setGravity(btVector3(0, -10, 0));
    world_.getWorldInfo().m_gravity = world_.getGravity();
    const btScalar s = 4;
    sheet_ = btSoftBodyHelpers::CreatePatch(world_.getWorldInfo(), btVector3(-s, 0, -s),
                                            btVector3(s, 0, -s), btVector3(-s, 0, s),
                                            btVector3(s, 0, s), 25, 25, 1 + 2 + 4 + 8, true);
    sheet_->getCollisionShape()->setMargin(btScalar(0.1));
    sheet_->generateBendingConstraints(2);
    sheet_->setTotalMass(20);
    sheet_->m_cfg.piterations = 10;
    world_.addSoftBody(sheet_);
    for (int i = 0; i < 3; ++i) {
      btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, &box_, btVector3(1, 1, 1) / 6);
      info.m_startWorldTransform.setOrigin(btVector3(btScalar(i - 1), btScalar(2 + i), 0));
      boxes_.push_back(std::make_unique<btRigidBody>(info));
      world_.addRigidBody(boxes_.back().get());
    }
  }
  ~SheetDemo() {
    for (const auto& box : boxes_) world_.removeRigidBody(box.get());
    world_.removeSoftBody(sheet_);
    delete sheet_;
  }
  SheetDemo(const SheetDemo&) = delete;
  SheetDemo& operator=(const SheetDemo&) = delete;

  void run(int num_steps) {
    for (int step = 0; step < num_steps; ++step) world_.stepSimulation(btScalar(1) / 60, 0);
  }
  [[nodiscard]] double stretch() const { return longest_stretch(*sheet_); }
  [[nodiscard]] bool are_boxes_on_it() const {
    for (const auto& box : boxes_) {
      const btVector3& place = box->getWorldTransform().getOrigin();
      if (!(place.y() > -4 && place.y() < 4)) return false;
    }
    return true;
  }

 private:
#ifdef WITH_WEFT
  weft::bridge::AdoptingSolver solver_;
#else
  btDefaultSoftBodySolver solver_;
#endif
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver constraints_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &constraints_, &configuration_,
                                  &solver_};
  btBoxShape box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
  btSoftBody* sheet_ = nullptr;
  std::vector<std::unique_ptr<btRigidBody>> boxes_;
};

int main(int argc, char** argv) {
  SheetDemo demo;
  demo.run(300);
  return end_with("three boxes on a sheet", demo.stretch(), demo.are_boxes_on_it(), argc, argv);
}
