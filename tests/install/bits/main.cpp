#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace {

using weft::bridge::SoftBodySolver;

/// FNV-1a over the bytes of the nodes' positions and velocities.
std::uint64_t hash_of(const btSoftBody& body, std::uint64_t hash) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    for (const btVector3& vector : {body.m_nodes[i].m_x, body.m_nodes[i].m_v}) {
      unsigned char bytes[3 * sizeof(btScalar)];
      std::memcpy(bytes, &vector.m_floats[0], sizeof bytes);
      for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211U;
    }
  }
  return hash;
}

/// The state after a third of a second of two cloths that hang by their corners, one stepped by the implicit solver with bending and a ball
/// below it, one by forces that other threads compute while the program goes on.
std::uint64_t run() {
  SoftBodySolver solver;
  solver.set_deferred(true);
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration, &solver);
  world.setGravity(btVector3(0, btScalar(-9.81), 0));
  world.getWorldInfo().m_gravity.setZero();

  weft::ClothMesh mesh =
      weft::make_cloth_grid({.nodes = {50, 50}, .size = {1.0, 1.0}, .total_mass = 0.25});
  mesh.pinned = {0, 49, 2450, 2499};
  const auto implicit = weft::bridge::make_cloth_body(world.getWorldInfo(), mesh, {});
  mesh.rest_positions.row(0).array() += 3;
  const auto explicit_body = weft::bridge::make_cloth_body(world.getWorldInfo(), mesh, {});
  world.addSoftBody(implicit.get());
  world.addSoftBody(explicit_body.get());
  btSphereShape shape(btScalar(0.1));
  btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape));
  ball.setWorldTransform(
      btTransform(btQuaternion::getIdentity(), btVector3(0, btScalar(-0.115), 0)));
  world.addRigidBody(&ball);

  const weft::forces::LawSpecification gravity{
      .law = "gravity", .sets = {}, .parameters = {{"acceleration", {0, -9.81, 0}}}};
  const auto refusal = solver.attach_fast(*implicit, mesh,
                                          {{"tension", {}, {{"stiffness", {1000.0}}}},
                                           {"hinge_torsion", {}, {{"rigidity", {1e-6}}}},
                                           {"velocity_damping", {}, {{"rate", {1.0}}}},
                                           gravity});
  solver.attach(*explicit_body, mesh,
                {{"tension", {}, {{"stiffness", {0.02}}}},
                 {"spring_damping", {}, {{"damping", {1e-5}}}},
                 gravity});
  for (int step = 0; step < 20; ++step) world.stepSimulation(btScalar(1.0 / 60), 0);
  std::uint64_t hash = hash_of(*explicit_body, hash_of(*implicit, 14695981039346656037U));
  for (const btSoftBody* body : {implicit.get(), explicit_body.get()}) {
    const auto blow_up = solver.blow_up(*body);
    if (!refusal && !blow_up) continue;
    std::fprintf(stderr, "%s\n", refusal ? refusal->c_str() : blow_up->reason.c_str());
    hash = 0;
  }
  world.removeRigidBody(&ball);
  world.removeSoftBody(implicit.get());
  world.removeSoftBody(explicit_body.get());
  return hash;
}

}  // namespace

// The state of a run as one number, which must not depend on how Weft was built, linked and found, nor on threads.
int main() {
  std::printf("threads from %s\n", weft::thread_library().c_str());
  const std::uint64_t hash = weft::with_threads(1, run);
  std::printf("hash %016llx\n", static_cast<unsigned long long>(hash));
  for (const int threads : {2, 4}) {
    if (weft::with_threads(threads, run) == hash) continue;
    std::fprintf(stderr, "other bits on %d threads\n", threads);
    return 1;
  }
  return hash == 0 ? 1 : 0;
}
