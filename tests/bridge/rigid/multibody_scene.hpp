#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/solver.hpp>

namespace weft::bridge {

/// Bullet's world for robots, with Weft's solver: what a program for PyBullet-like robots has.
class RobotWorld {
 public:
  static constexpr double kStep = 1.0 / 60;  // [s]

  explicit RobotWorld(double gravity = -9.81) {
    world_.setGravity(btVector3(0, static_cast<btScalar>(gravity), 0));
    world_.getWorldInfo().m_gravity = world_.getGravity();
    world_.getWorldInfo().air_density = 0;
    world_.getWorldInfo().m_sparsesdf.Initialize();
  }
  ~RobotWorld() {
    for (auto& motor : motors_) world_.removeMultiBodyConstraint(motor.get());
    for (auto& cloth : cloths_) world_.removeSoftBody(cloth.get());
    for (auto& collider : colliders_) world_.removeCollisionObject(collider.get());
    for (auto& robot : robots_) world_.removeMultiBody(robot.get());
    for (auto& rigid : rigids_) world_.removeRigidBody(rigid.get());
  }
  RobotWorld(const RobotWorld&) = delete;
  RobotWorld& operator=(const RobotWorld&) = delete;

  btSoftBody& add_cloth(const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws,
                        double friction = 0.5, double margin = 0.01) {
    cloths_.push_back(make_cloth_body(world_.getWorldInfo(), mesh,
                                      {.collision_margin = margin, .friction = friction}));
    btSoftBody& body = *cloths_.back();
    world_.addSoftBody(&body);
    EXPECT_FALSE(solver_.attach_fast(body, mesh, laws, {.may_sleep = false}));
    return body;
  }
  btRigidBody& add_box(const btVector3& half, double mass, const btVector3& place) {
    btCollisionShape* const shape = make_box(half);
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    rigids_.push_back(
        std::make_unique<btRigidBody>(static_cast<btScalar>(mass), nullptr, shape, inertia));
    btRigidBody& body = *rigids_.back();
    body.setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
    body.setInterpolationWorldTransform(body.getWorldTransform());
    body.setFriction(1);
    body.setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(&body);
    return body;
  }

  /// A multibody without joints yet; finish() adds it to the world. mass 0: a fixed base.
  btMultiBody& add_robot(int num_links, double mass, const btVector3& inertia,
                         const btVector3& place) {
    robots_.push_back(std::make_unique<btMultiBody>(num_links, static_cast<btScalar>(mass), inertia,
                                                    mass == 0, false));
    btMultiBody& robot = *robots_.back();
    robot.setBasePos(place);
    robot.setLinearDamping(0);
    robot.setAngularDamping(0);
    return robot;
  }
  void finish(btMultiBody& robot) {
    robot.finalizeMultiDof();
    robot.setLinearDamping(0);
    robot.setAngularDamping(0);
    world_.addMultiBody(&robot);
  }
  /// A collider of a link, or of the base (-1). To be called after finish().
  btMultiBodyLinkCollider& add_collider(btMultiBody& robot, int link, const btVector3& half,
                                        double friction = 1) {
    colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(&robot, link));
    btMultiBodyLinkCollider& collider = *colliders_.back();
    collider.setCollisionShape(make_box(half));
    collider.setFriction(static_cast<btScalar>(friction));
    if (link < 0) {
      robot.setBaseCollider(&collider);
    } else {
      robot.getLink(link).m_collider = &collider;
    }
    btAlignedObjectArray<btQuaternion> rotations;
    btAlignedObjectArray<btVector3> origins;
    robot.forwardKinematics(rotations, origins);
    robot.updateCollisionObjectWorldTransforms(rotations, origins);
    collider.setActivationState(DISABLE_DEACTIVATION);
    world_.addCollisionObject(&collider, btBroadphaseProxy::DefaultFilter,
                              btBroadphaseProxy::AllFilter);
    return collider;
  }
  btMultiBodyJointMotor& add_motor(btMultiBody& robot, int link, double speed, double force) {
    auto motor = std::make_unique<btMultiBodyJointMotor>(
        &robot, link, static_cast<btScalar>(speed),
        static_cast<btScalar>(force * kStep));  // Bullet's limit is an impulse
    motor->finalizeMultiDof();
    world_.addMultiBodyConstraint(motor.get());
    motors_.push_back(std::move(motor));
    return *motors_.back();
  }
  void step(int num_steps = 1, double time_step = kStep) {
    for (int i = 0; i < num_steps; ++i) {
      world_.stepSimulation(static_cast<btScalar>(time_step), 0);
    }
  }
  [[nodiscard]] btSoftMultiBodyDynamicsWorld& world() { return world_; }
  [[nodiscard]] SoftBodySolver& solver() { return solver_; }

 private:
  btCollisionShape* make_box(const btVector3& half) {
    shapes_.push_back(std::make_unique<btBoxShape>(half));
    shapes_.back()->setMargin(btScalar(0.001));
    return shapes_.back().get();
  }

  SoftBodySolver solver_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver constraints_;
  btSoftMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &constraints_, &configuration_,
                                      &solver_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btSoftBody>> cloths_;
  std::vector<std::unique_ptr<btRigidBody>> rigids_;
  std::vector<std::unique_ptr<btMultiBody>> robots_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyJointMotor>> motors_;
};

}  // namespace weft::bridge
