#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <weft/bridge/classic/nodes/node_colors.hpp>
#include <weft/custom_forces/law_set.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::bridge {
namespace {

ClothMesh mesh_with_everything() {
  ClothGrid grid;
  grid.nodes = {7, 6};
  grid.stencil = GridStencil::k8Neighbour;  // so that hinges reach farther than edges
  ClothMesh mesh = make_cloth_grid(grid);
  connect(mesh, "far", 0, {40, 41});
  for (int i = 0; i < mesh.num_nodes(); ++i) {  // bent, so that every law couples what it can
    mesh.rest_positions(1, i) = 0.05 * ((i * 7) % 5);
  }
  return mesh;
}

TEST(NodeColors, EveryNodeIsInOneGroup) {
  const ClothMesh mesh = mesh_with_everything();
  std::vector<int> seen;
  for (const auto& group : node_colors(mesh)) seen.insert(seen.end(), group.begin(), group.end());
  std::sort(seen.begin(), seen.end());
  std::vector<int> all;
  for (int i = 0; i < mesh.num_nodes(); ++i) all.push_back(i);
  EXPECT_EQ(seen, all);
}

TEST(NodeColors, AGridOf24NeighborsNeedsNineGroups) {
  ClothGrid grid;
  grid.nodes = {12, 9};
  EXPECT_EQ(node_colors(make_cloth_grid(grid)).size(), 9U);
}

// The claim itself, for every law of force level: moving one node moves no force on another of its group.
TEST(NodeColors, NoLawCouplesNodesOfOneGroup) {
  const ClothMesh mesh = mesh_with_everything();
  const auto groups = node_colors(mesh);
  const Matrix3X<double> velocities = 0.3 * mesh.rest_positions.colwise().reverse();
  const Matrix3X<double> positions = 1.1 * mesh.rest_positions;
  for (const forces::LawInfo* info : forces::all_laws()) {
    // Dampers of a body's rotation couple all its nodes: they enter the effective mass roughly.
    if (info->traits.level != forces::LawTraits::Level::kForce) continue;
    if (info->traits.needs_closed_surface) continue;  // a gas couples all nodes as well
    forces::LawSpecification specification{std::string(info->id), {}, {}};
    for (const auto& parameter : info->parameters) {
      if (!parameter.required) continue;
      specification.parameters[std::string(parameter.name)].assign(
          static_cast<std::size_t>(parameter.size), 1.0);
    }
    forces::LawSet<double> laws;
    laws.add(forces::make_law<double>(specification, mesh));
    for (const auto& group : groups) {
      Matrix3X<double> direction = Matrix3X<double>::Zero(3, mesh.num_nodes());
      direction.col(group.front()) << 1, 2, 3;
      Matrix3X<double> product = Matrix3X<double>::Zero(3, mesh.num_nodes());
      laws.add_stiffness_product({positions, velocities, mesh.masses}, direction, product);
      laws.add_damping_product({positions, velocities, mesh.masses}, direction, product);
      for (std::size_t i = 1; i < group.size(); ++i) {
        ASSERT_EQ(product.col(group[i]).norm(), 0.0)
            << info->id << ": node " << group.front() << " moves node " << group[i];
      }
    }
  }
}

}  // namespace
}  // namespace weft::bridge
