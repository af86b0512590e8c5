#include <weft/bridge/deformable/deformable_world.hpp>

#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <weft/bridge/snapshot/bullet_state.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

struct DeformableWorld::Parts {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btDeformableMultiBodyConstraintSolver constraint_solver;
  std::vector<std::shared_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> rigid_bodies;
  std::vector<std::unique_ptr<btSoftBody>> soft_bodies;
};

DeformableWorld::DeformableWorld(const DeformableWorldSettings& settings)
    : parts_(std::make_unique<Parts>()), solver_(std::make_unique<DeformableSolver>()) {
  if (settings.contact_iterations < 1) {
    throw InvalidArgument("deformable world: contact_iterations = " +
                          std::to_string(settings.contact_iterations) + ", expected >= 1");
  }
  solver_->set_newton_iterations(settings.newton_iterations);
  parts_->constraint_solver.setDeformableSolver(solver_.get());
  world_ = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
      &parts_->dispatcher, &parts_->broadphase, &parts_->constraint_solver, &parts_->configuration,
      solver_.get());
  const Vector3<btScalar> gravity = settings.gravity.cast<btScalar>();
  world_->setGravity(btVector3(gravity[0], gravity[1], gravity[2]));
  world_->setImplicit(settings.scheme == DeformableScheme::kImplicit);
  world_->setUseProjection(settings.scheme == DeformableScheme::kImplicit);
  world_->setLineSearch(false);
  world_->getSolverInfo().m_numIterations = settings.contact_iterations;
  btSoftBodyWorldInfo& info = world_->getWorldInfo();
  info.m_gravity.setZero();
  info.air_density = 0;
  // Bullet clamps velocities to this per step; beyond kBlowUpSpeed for every step over a
  // millisecond, so that an explosion is seen and not trimmed.
  info.m_maxDisplacement = static_cast<btScalar>(kBlowUpSpeed);
  info.m_sparsesdf.setDefaultVoxelsz(static_cast<btScalar>(settings.distance_field_voxel));
  info.m_sparsesdf.Reset();
}

DeformableWorld::~DeformableWorld() {
  for (const auto& body : parts_->soft_bodies) world_->removeSoftBody(body.get());
  for (const auto& body : parts_->rigid_bodies) world_->removeRigidBody(body.get());
}

btSoftBody& DeformableWorld::add(std::unique_ptr<btSoftBody> body) {
  prepare_for_deformable_world(*body);
  world_->addSoftBody(body.get());
  parts_->soft_bodies.push_back(std::move(body));
  return *parts_->soft_bodies.back();
}

btRigidBody& DeformableWorld::add(std::unique_ptr<btRigidBody> body,
                                  std::shared_ptr<btCollisionShape> shape) {
  parts_->shapes.push_back(std::move(shape));
  world_->addRigidBody(body.get());
  parts_->rigid_bodies.push_back(std::move(body));
  return *parts_->rigid_bodies.back();
}

namespace {

/// Velocities that only the deformable world has: that of the step before, and that which pushed the node out.
void serialize_velocities(StateArchive& archive, btSoftBody& body) {
  using Node = btSoftBody::Node;
  const auto serialize_if = [&](bool is_stored, btVector3 Node::*vector, const auto& otherwise) {
    archive.value(is_stored);
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      Node& node = body.m_nodes[i];
      if (is_stored) {
        serialize(archive, node.*vector);
      } else if (archive.is_reading()) {
        node.*vector = otherwise(node);
      }
    }
  };
  bool has_last = false;
  bool has_push = false;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    has_last = has_last || body.m_nodes[i].m_vn != body.m_nodes[i].m_v;
    has_push = has_push || !body.m_nodes[i].m_splitv.isZero();
  }
  serialize_if(has_last, &Node::m_vn, [](const Node& node) { return node.m_v; });
  serialize_if(has_push, &Node::m_splitv, [](const Node&) { return btVector3(0, 0, 0); });
}

bool starts_elsewhere(const btSoftBody& body) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    if (body.m_nodes[i].m_q != body.m_nodes[i].m_x) return true;
  }
  return false;
}

}  // namespace

void DeformableWorld::serialize(StateArchive& archive) {
  archive.part("deformable world");
  archive.expect(static_cast<int>(sizeof(btScalar)), "bytes of a number");
  archive.expect(parts_->soft_bodies.size(), "number of soft bodies");
  archive.expect(parts_->rigid_bodies.size(), "number of rigid bodies");
  for (const auto& body : parts_->soft_bodies) {
    bridge::serialize(archive, starts_elsewhere(*body), *body);
    serialize_velocities(archive, *body);
  }
  for (const auto& body : parts_->rigid_bodies) bridge::serialize(archive, *body);
  bridge::serialize(archive, forces());
}

void DeformableWorld::step(double time_step) {
  world_->stepSimulation(static_cast<btScalar>(time_step), 0);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
