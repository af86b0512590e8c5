// A program with Bullet's deformable world gets Weft's laws: the same chain hangs there as in the classic world, and as theory says.
#include <cmath>
#include <cstdio>

#include <weft/bridge/deformable/deformable_world.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/rope.hpp>
#include <weft/weft.hpp>

namespace {

constexpr int kWeights = 10;
constexpr double kMass = 0.05;        // of each [kg]
constexpr double kStiffness = 400.0;  // [N/m]
constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kStep = 1 / 1000.0;  // [s], which explicit springs of this stiffness allow

weft::ClothMesh chain() {
  weft::ClothMesh mesh = weft::make_rope({.nodes = kWeights + 1,
                                          .start = {0, 0, 0},
                                          .end = {0, -1, 0},
                                          .total_mass = kMass * (kWeights + 1),
                                          .lumping = weft::MassLumping::kUniform});
  mesh.pinned = {0};
  return mesh;
}

const std::vector<weft::forces::LawSpecification> kLaws = {
    {"tension", {"stretch"}, {{"stiffness", {kStiffness}}}},
    weft::laws::velocity_damping({.rate = 3}),
    weft::laws::gravity({.acceleration = {0, -kGravity, 0}})};

double tip_drop(const btSoftBody& body) {
  return -1 - static_cast<double>(body.m_nodes[kWeights].m_x.y());
}

double in_deformable_world() {
  weft::bridge::DeformableWorld world({});
  btSoftBody& body =
      world.add(weft::bridge::make_cloth_body(world.info(), chain(), {.collision_margin = 0.01}));
  world.forces().attach(body, chain(), kLaws);
  for (int step = 0; step < 8000; ++step) world.step(kStep);
  return tip_drop(body);
}

double in_classic_world() {
  weft::bridge::SoftWorld world({});
  btSoftBody& body =
      world.add(weft::bridge::make_cloth_body(world.info(), chain(), {.collision_margin = 0.01}));
  if (world.solver().attach_fast(body, chain(), kLaws, {.may_sleep = false})) return std::nan("");
  for (int step = 0; step < 600; ++step) world.step(1 / 60.0);
  return tip_drop(body);
}

}  // namespace

int main() {
  // Link n from below carries n weights.
  const double theory = kMass * kGravity / kStiffness * kWeights * (kWeights + 1) / 2;
  const double deformable = in_deformable_world();
  const double classic = in_classic_world();
  std::printf(
      "a chain stretches by %.5f m in theory, %.5f m in the deformable and %.5f m in the classic "
      "world\n",
      theory, deformable, classic);
  return std::abs(deformable - theory) < 1e-3 * theory && std::abs(classic - theory) < 1e-3 * theory
             ? 0
             : 1;
}
