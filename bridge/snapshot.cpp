#include <weft/bridge/snapshot.hpp>

#include <weft/bridge/snapshot/world_state.hpp>
#include <weft/core/trace.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

bool Snapshot::is_fresh(const SoftBodySolver& solver, const btSoftBody& body) {
  return WorldState::is_fresh(solver, body);
}

void Snapshot::save(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver) {
  const btSoftBodyArray& bodies = world.getSoftBodyArray();
  bool are_fresh = true;
  for (int i = 0; i < bodies.size(); ++i) are_fresh = are_fresh && is_fresh(solver, *bodies[i]);
  write(world, solver);
  if (!are_fresh) restore(world, solver);
}

void Snapshot::write(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver) {
  const TraceScope trace("save snapshot");
  WorldState state(world, solver);
  state.check();
  StateArchive archive = StateArchive::writer(std::move(bytes_));
  state.serialize(archive);
  bytes_ = archive.take();
}

void Snapshot::restore(btSoftRigidDynamicsWorld& world, SoftBodySolver& solver) const {
  const TraceScope trace("restore snapshot");
  StateArchive archive = StateArchive::reader(bytes_);
  WorldState(world, solver).serialize(archive);
  archive.end();
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
