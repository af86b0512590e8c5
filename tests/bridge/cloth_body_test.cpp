#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/link_stiffness.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
namespace {

constexpr double kClothBodyEpsilon = std::numeric_limits<btScalar>::epsilon();

ClothMesh small_cloth() {
  ClothGrid grid;
  grid.nodes = {6, 5};
  grid.size = {1.0, 0.8};
  grid.total_mass = 0.3;
  ClothMesh mesh = make_cloth_grid(grid);
  mesh.pinned = {0, 5};
  return mesh;
}

TEST(ClothBody, NodesFacesMassesAndPinsAreTheMeshs) {
  SoftWorld world({});
  const ClothMesh mesh = small_cloth();
  const auto body = make_cloth_body(world.info(), mesh, {});
  ASSERT_EQ(body->m_nodes.size(), mesh.num_nodes());
  EXPECT_EQ(body->m_faces.size(), mesh.triangles.cols());
  EXPECT_EQ(body->m_links.size(), 0);
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    const double inverse_mass = static_cast<double>(body->m_nodes[i].m_im);
    const bool pinned = i == 0 || i == 5;
    EXPECT_NEAR(inverse_mass * mesh.masses[i], pinned ? 0.0 : 1.0, 4 * kClothBodyEpsilon);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(static_cast<double>(body->m_nodes[i].m_x[axis]), mesh.rest_positions(axis, i),
                  kClothBodyEpsilon);
    }
  }
}

TEST(ClothBody, EveryLinkHasTheStiffnessOfItsOwnMasses) {
  SoftWorld world({});
  const ClothMesh mesh = small_cloth();
  ClothSettings settings;
  settings.position_iterations = 7;
  settings.links = {{{"stretch"}, 30.0}, {{"shear", "bend"}, 5.0}};
  const auto body = make_cloth_body(world.info(), mesh, settings);
  const auto num_stretch = mesh.edges_of({"stretch"}).cols();
  ASSERT_EQ(body->m_links.size(), mesh.num_edges());
  for (int l = 0; l < body->m_links.size(); ++l) {
    const btSoftBody::Link& link = body->m_links[l];
    const double inverse_sum = static_cast<double>(link.m_n[0]->m_im + link.m_n[1]->m_im);
    const double stiffness = stiffness_from_link_factor(
        static_cast<double>(link.m_material->m_kLST), {1.0 / inverse_sum, 7, settings.time_step});
    const double expected = l < num_stretch ? 30.0 : 5.0;
    // kLST is rounded to btScalar; near 1 the map magnifies that by 1 / (1 - kLST).
    const double magnified = 1.0 / (1.0 - static_cast<double>(link.m_material->m_kLST));
    EXPECT_NEAR(stiffness / expected, 1.0, 64 * kClothBodyEpsilon * magnified);
  }
}

TEST(ClothBody, FirstStepKeepsRestLengthsOfTheMesh) {
  SoftWorld world({});
  const ClothMesh mesh = small_cloth();
  ClothSettings settings;
  settings.links = {{{}, 10.0}};
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, settings));
  for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_x *= btScalar(1.25);
  world.step(1.0 / 128);
  for (int l = 0; l < body.m_links.size(); ++l) {
    const btSoftBody::Link& link = body.m_links[l];
    const auto a = link.m_n[0] - &body.m_nodes[0];
    const auto b = link.m_n[1] - &body.m_nodes[0];
    const double rest = (mesh.rest_positions.col(b) - mesh.rest_positions.col(a)).norm();
    EXPECT_NEAR(static_cast<double>(link.m_rl), rest, 8 * kClothBodyEpsilon);
  }
}

TEST(ClothBody, MeshThatDoesNotFitTogetherIsRefused) {
  SoftWorld world({});
  ClothMesh mesh = small_cloth();
  mesh.masses.conservativeResize(3);
  EXPECT_THROW((void)make_cloth_body(world.info(), mesh, {}), InvalidArgument);
  mesh = small_cloth();
  mesh.masses[4] = 0;
  EXPECT_THROW((void)make_cloth_body(world.info(), mesh, {}), InvalidArgument);
  mesh = small_cloth();
  mesh.pinned.push_back(30);
  EXPECT_THROW((void)make_cloth_body(world.info(), mesh, {}), InvalidArgument);
  mesh = small_cloth();
  mesh.triangles(0, 0) = -1;
  EXPECT_THROW((void)make_cloth_body(world.info(), mesh, {}), InvalidArgument);
}

TEST(ClothBody, SettingsOutOfTheirDomainAreRefused) {
  SoftWorld world({});
  const ClothMesh mesh = small_cloth();
  ClothSettings settings;
  settings.collision_margin = -1;
  EXPECT_THROW((void)make_cloth_body(world.info(), mesh, settings), InvalidArgument);
  settings = {};
  settings.friction = std::nan("");
  EXPECT_THROW((void)make_cloth_body(world.info(), mesh, settings), InvalidArgument);
  settings = {};
  settings.position_iterations = 0;
  EXPECT_THROW((void)make_cloth_body(world.info(), mesh, settings), InvalidArgument);
  settings = {};
  settings.links = {{{"no_such_set"}, 1.0}};
  EXPECT_THROW((void)make_cloth_body(world.info(), mesh, settings), InvalidArgument);
}

}  // namespace
}  // namespace weft::bridge
