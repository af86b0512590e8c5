#include "bench/bullet/workloads/rest_drape.hpp"

#include <cmath>
#include <memory>

#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::bench {
namespace {

constexpr int kNodes = 21;           // along an edge
constexpr double kStiffness = 50.0;  // [N/m]
constexpr double kDuration = 6.0;    // [s]
constexpr double kHeldAt = -0.5;     // [m] along x
constexpr double kGap = 0.8;         // [m] between the edges of the hammock

ClothMesh mesh_of(RestDrape drape) {
  ClothGrid grid;
  grid.nodes = {kNodes, kNodes};
  grid.total_mass = 0.25;
  ClothMesh mesh = make_cloth_grid(grid);
  for (int j = 0; j < kNodes; ++j) {
    mesh.pinned.push_back(grid_node(grid, 0, j));
    if (drape == RestDrape::kHammock) mesh.pinned.push_back(grid_node(grid, -1, j));
  }
  return mesh;
}

/// The hammock starts as the arc of a circle over its gap.
void place(RestDrape drape, const ClothMesh& mesh, btSoftBody& body) {
  if (drape == RestDrape::kBanner) return;
  double half_angle = 1.0;  // of the arc: sin(a) / a = gap
  for (int i = 0; i < 50; ++i) half_angle = std::sin(half_angle) / kGap;
  const double radius = 0.5 / half_angle;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const double angle = 2 * half_angle * mesh.rest_positions(0, i);
    const btVector3 x(static_cast<btScalar>(radius * std::sin(angle)),
                      static_cast<btScalar>(radius * (std::cos(half_angle) - std::cos(angle))),
                      body.m_nodes[i].m_x.z());
    body.m_nodes[i].m_x = x;
    body.m_nodes[i].m_q = x;
  }
}

}  // namespace

Matrix3X<double> rest_of(RestDrape drape, const DrapeSolver& solver) {
  const ClothMesh mesh = mesh_of(drape);
  bridge::SoftWorld world(bridge::SoftWorldSettings{});
  bridge::ClothSettings settings{.time_step = solver.time_step};
  if (solver.rounds == 0) {
    settings.position_iterations = solver.iterations;
    settings.links.push_back({{}, kStiffness});
  }
  btSoftBody& body = world.add(bridge::make_cloth_body(world.info(), mesh, settings));
  place(drape, mesh, body);
  std::vector<forces::LawSpecification> laws = {
      {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
      {"velocity_damping", {}, {{"rate", {3.0}}}}};
  if (solver.rounds == 0) {
    world.solver().attach(body, mesh, laws);
  } else {
    laws.push_back({"tension", {}, {{"stiffness", {kStiffness}}}});
    (void)world.solver().attach_fast(
        body, mesh, laws, {.solver = {solver.rounds, solver.iterations}, .may_sleep = false});
  }
  const long num_steps = std::lround(kDuration / solver.time_step);
  for (long step = 0; step < num_steps; ++step) world.step(solver.time_step);
  Matrix3X<btScalar> x;
  Matrix3X<btScalar> v;
  bridge::read_nodes(body, x, v);
  return x.cast<double>();
}

VectorX<double> distances(RestDrape drape, const Matrix3X<double>& rest,
                          const Matrix3X<double>& other) {
  VectorX<double> apart = (rest - other).colwise().norm();
  if (drape != RestDrape::kBanner) return apart;
  Matrix3X<double> mirrored = other;
  mirrored.row(0) = 2 * kHeldAt - other.row(0).array();
  const VectorX<double> from_mirrored = (rest - mirrored).colwise().norm();
  return from_mirrored.norm() < apart.norm() ? from_mirrored : apart;
}

std::string to_string(RestDrape drape) {
  return drape == RestDrape::kHammock ? "hammock" : "banner";
}

}  // namespace weft::bench
