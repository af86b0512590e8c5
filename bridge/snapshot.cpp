#include <weft/bridge/snapshot.hpp>

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/snapshot/bullet_state.hpp>
#include <weft/bridge/snapshot/object_table.hpp>
#include <weft/core/error.hpp>
#include <weft/core/trace.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

constexpr int kVersion = 1;

/// Which objects the world has, so that a snapshot of another one is not taken for its own.
void check_objects(StateArchive& archive, btCollisionObjectArray& objects) {
  archive.part("world");
  archive.expect(kVersion, "version");
  archive.expect(static_cast<int>(sizeof(btScalar)), "bytes of a number");
  archive.expect(objects.size(), "number of objects");
  for (int i = 0; i < objects.size(); ++i) {
    archive.expect(objects[i]->getInternalType(), "type of an object");
    archive.expect(objects[i]->getCollisionShape()->getShapeType(), "shape of an object");
  }
}

/// Trees of a body that only Weft solves bound its nodes and decide nothing.
bool are_trees_asked(const SoftBodySolver& solver, const btSoftBody& body) {
  return !solver.is_fast(body) || (body.m_cfg.collisions & btSoftBody::fCollision::VF_SS) != 0;
}

void serialize_joints(StateArchive& archive, btSoftRigidDynamicsWorld& world) {
  archive.part("joints");
  archive.expect(world.getNumConstraints(), "number of joints");
  for (int i = 0; i < world.getNumConstraints(); ++i) {
    btTypedConstraint& joint = *world.getConstraint(i);
    bool is_enabled = joint.isEnabled();
    btScalar impulse = joint.internalGetAppliedImpulse();
    archive.value(is_enabled);
    archive.value(impulse);
    joint.setEnabled(is_enabled);
    joint.internalSetAppliedImpulse(impulse);
  }
}

}  // namespace

void Snapshot::save(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver) {
  const btSoftBodyArray& bodies = world.getSoftBodyArray();
  bool is_fresh = true;
  for (int i = 0; i < bodies.size(); ++i) is_fresh = is_fresh && solver.is_fresh(*bodies[i]);
  write(world, solver);
  if (!is_fresh) restore(world, solver);
}

void Snapshot::write(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver) {
  const TraceScope trace("save snapshot");
  btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) check_savable(*objects[i], i);
  StateArchive archive = StateArchive::writer(std::move(bytes_));
  solver.serialize(archive, world);
  bytes_ = archive.take();
}

void Snapshot::restore(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver) const {
  const TraceScope trace("restore snapshot");
  StateArchive archive = StateArchive::reader(bytes_);
  solver.serialize(archive, world);
  archive.end();
}

void SoftBodySolver::serialize(StateArchive& archive, btSoftRigidDynamicsWorld& world) {
  btCollisionObjectArray& objects = world.getCollisionObjectArray();
  check_objects(archive, objects);
  const ObjectTable table(world);
  for (int i = 0; i < objects.size(); ++i) {
    btSoftBody* const body = btSoftBody::upcast(objects[i]);
    if (body == nullptr) {
      bridge::serialize(archive, *objects[i]);
      continue;
    }
    bridge::serialize(archive, is_still(*body) || !body->isActive(), *body);
    serialize(archive, table, *body);
    bool has_face_tree = !body->m_fdbvt.empty();
    archive.value(has_face_tree);
    if (are_trees_asked(*this, *body)) {
      rebuild_trees(has_face_tree, *body);
      body->updateNormals();
    } else if (archive.is_reading()) {
      body->updateNormals();
    }
  }
  serialize_joints(archive, world);
  rebuild_broadphase(archive, world);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
