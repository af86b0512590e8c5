// A handle of a cloth: laws with names that the compiler knows, contacts, state; and what it says when the cloth is gone.
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include <weft/weft.hpp>

#include <btBulletDynamicsCommon.h>

namespace laws = weft::laws;

int main() {
  weft::bridge::SoftWorld world({});
  auto ground = std::make_shared<btBoxShape>(btVector3(2, btScalar(0.5), 2));
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, ground.get());
  info.m_startWorldTransform.setOrigin(btVector3(0, btScalar(-0.5), 0));
  world.add(std::make_unique<btRigidBody>(info), ground);

  const weft::ClothMesh mesh = weft::make_cloth_grid(
      {.nodes = {21, 21}, .size = {0.5, 0.5}, .center = {0, 0.1, 0}, .total_mass = 0.2});
  btSoftBody& body =
      world.add(weft::bridge::make_cloth_body(world.info(), mesh, {.collision_margin = 0.005}));
  const auto refusal = world.solver().attach_fast(
      body, mesh,
      {laws::tension({.stiffness = 500.0}), laws::gravity({.acceleration = {0, -9.81, 0}})});
  if (refusal) return std::fprintf(stderr, "%s\n", refusal->c_str()), 2;
  weft::bridge::Cloth cloth = world.solver().cloth(body);

  bool has_landed = false;
  cloth.on_contact([&](const std::vector<weft::bridge::ClothContactPoint>& contacts) {
    if (!has_landed) std::printf("node %d lands first\n", contacts[0].node);
    has_landed = true;
  });
  cloth.on_blow_up([](const weft::bridge::BodyBlowUp& blow_up) {
    std::fprintf(stderr, "blown up: %s\n", blow_up.reason.c_str());
  });
  for (int step = 0; step < 60; ++step) world.step(1 / 60.0);
  double weight = 0;  // that the ground bears [N]
  for (const weft::bridge::ClothContactPoint& contact : cloth.contacts()) {
    weight += 60 * static_cast<double>(contact.impulse.y());
  }
  std::printf("the ground bears %.3f N of %.3f\n", weight, 0.2 * 9.81);

  // Between steps: gravity of the moon, and damping in addition.
  cloth.set(laws::gravity({.acceleration = {0, -1.62, 0}}));
  cloth.set(laws::velocity_damping({.rate = 0.5}));
  for (int step = 0; step < 60; ++step) world.step(1 / 60.0);
  double on_the_moon = 0;
  for (const weft::bridge::ClothContactPoint& contact : cloth.contacts()) {
    on_the_moon += 60 * static_cast<double>(contact.impulse.y());
  }
  std::printf("%zu laws, %.3f N on the moon\n", cloth.laws().size(), on_the_moon);

  for (int step = 0; step < 120; ++step) world.step(1 / 60.0);
  const bool sleeps = cloth.state().status == weft::bridge::ClothState::Status::kAsleep;
  world.solver().detach(body);
  const auto reason = cloth.set(laws::tension({.stiffness = 1.0}));
  std::printf("after detach(): %s\n", reason ? reason->c_str() : "nothing");

  const bool is_right = has_landed && std::abs(weight - 0.2 * 9.81) < 0.02 &&
                        std::abs(on_the_moon - 0.2 * 1.62) < 0.01 && sleeps && reason &&
                        *reason == "the body is without laws";
  return is_right ? 0 : 1;
}
