#include <cmath>

#include <gtest/gtest.h>
#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/mesh/rope.hpp>
#include <weft/mesh/surface_body.hpp>
#include <weft/mesh/topology/hinges.hpp>

#include "tests/custom_forces/one_law.hpp"

namespace weft {
namespace {

constexpr double kBodySourcesRoundoff = 1e-14;  // of sums of a few hundred numbers near 1, relative

/// A tetrahedron with its front outside; two triangles of it alone are an open surface.
Surface tetrahedron() {
  Surface surface;
  surface.positions.resize(3, 4);
  surface.positions << 0, 1, 0, 0,  //
      0, 0, 1, 0,                   //
      0, 0, 0, 1;
  surface.triangles.resize(3, 4);
  surface.triangles << 0, 0, 0, 1,  //
      2, 1, 3, 2,                   //
      1, 3, 2, 3;
  return surface;
}

Surface two_triangles() {
  Surface surface;
  surface.positions.resize(3, 4);
  surface.positions << 0, 1, 0, 1,  //
      0, 0, 1, 1,                   //
      0, 0, 0, 0;
  surface.triangles.resize(3, 2);
  surface.triangles << 0, 1,  //
      1, 3,                   //
      2, 2;
  return surface;
}

TEST(SurfaceBody, TiesEdgesAndTheFarCornersOfHingesOnceEach) {
  const ClothMesh open = make_surface_body(two_triangles(), {});
  EXPECT_EQ(open.edges_of({"stretch"}).cols(), 5);
  ASSERT_EQ(open.edges_of({"bend"}).cols(), 1);
  EXPECT_EQ(open.edges_of({"bend"}).col(0), Eigen::Vector2i(0, 3));
  const ClothMesh closed = make_surface_body(tetrahedron(), {});
  EXPECT_TRUE(is_closed_surface(closed.triangles));
  EXPECT_EQ(closed.edges_of({"stretch"}).cols(), 6);
  EXPECT_EQ(closed.edges_of({"bend"}).cols(), 0) << "edges tie the far corners already";
}

TEST(SurfaceBody, SharesOutExactlyTheMassByAreaAndGivesTheCentreItsPart) {
  const Surface surface = tetrahedron();
  const ClothMesh shell = make_surface_body(surface, {.total_mass = 3.0});
  EXPECT_NEAR(shell.masses.sum(), 3.0, 3.0 * kBodySourcesRoundoff);
  const VectorX<double> areas = node_areas(shell);
  EXPECT_NEAR(areas.sum(), surface_area(surface), kBodySourcesRoundoff);
  EXPECT_NEAR(areas.sum(), 1.5 + std::sqrt(3.0) / 2, kBodySourcesRoundoff);
  EXPECT_LE((shell.masses - areas * (3.0 / areas.sum())).cwiseAbs().maxCoeff(),
            kBodySourcesRoundoff);

  const ClothMesh body = make_surface_body(surface, {.total_mass = 3.0, .center_mass_share = 0.2});
  EXPECT_NEAR(body.masses.sum(), 3.0, 3.0 * kBodySourcesRoundoff);
  EXPECT_NEAR(body.masses[4], 0.6, kBodySourcesRoundoff);
  const ClothMesh equal =
      make_surface_body(surface, {.total_mass = 3.0, .lumping = MassLumping::kUniform});
  EXPECT_EQ(equal.masses, VectorX<double>::Constant(4, 0.75));
}

TEST(SurfaceBody, TheCentreNodeStandsInTheMiddleTiedToEveryOther) {
  const ClothMesh mesh = make_icosphere(
      {.radius = 2.0, .frequency = 3, .center = {1, 2, 3}, .center_mass_share = kCenterMassShare});
  const int center = mesh.num_nodes() - 1;
  EXPECT_LE((mesh.rest_positions.col(center) - Vector3<double>(1, 2, 3)).norm(),
            2 * kBodySourcesRoundoff);
  const Edges spokes = mesh.edges_of({"center"});
  ASSERT_EQ(spokes.cols(), center);
  EXPECT_EQ(spokes.row(1).minCoeff(), center);
  const VectorX<double> lengths = edge_lengths(mesh.rest_positions, spokes);
  EXPECT_LE((lengths.array() - 2.0).abs().maxCoeff(), 4 * kBodySourcesRoundoff);
  ASSERT_EQ(mesh.connection_sets.size(), 1U);
  EXPECT_EQ(mesh.connection_sets[0].connections, spokes);
}

TEST(SurfaceBody, EveryLawOfABodyTakesAMeshWithACentreNode) {
  const ClothMesh mesh = make_icosphere({.frequency = 3, .center_mass_share = kCenterMassShare});
  const std::vector<forces::LawSpecification> laws = {
      {"pressure", {}, {{"pressure", {100.0}}}},
      {"hinge_torsion", {}, {{"rigidity", {1.0}}}},
      {"nonlocal_torsion", {"center"}, {{"stiffness", {1.0}}}},
      {"tension", {"center"}, {{"stiffness", {1.0}}}},
      {"wind", {}, {{"velocity", {1.0, 0.0, 0.0}}}}};
  Matrix3X<double> moved = mesh.rest_positions;
  moved.col(0) *= 1.1;
  moved.col(mesh.num_nodes() - 1) += Vector3<double>(0.1, 0.2, -0.1);
  for (const forces::LawSpecification& law : laws) {
    const Matrix3X<double> force = forces::forces_on(law, mesh, moved, 0 * moved);
    EXPECT_TRUE(force.allFinite()) << law.law;
    EXPECT_GT(force.norm(), 0.0) << law.law;
    const bool acts_on_triangles =
        law.law == "pressure" || law.law == "hinge_torsion" || law.law == "wind";
    EXPECT_EQ(force.rightCols(1).norm() == 0.0, acts_on_triangles) << law.law;
  }
}

TEST(SurfaceBody, RefusesWhatIsNoSurface) {
  const auto refuses = [](Surface surface, const BodyMass& mass, const std::string& part) {
    try {
      (void)make_surface_body(surface, mass);
    } catch (const InvalidArgument& error) {
      return std::string(error.what()).find(part) != std::string::npos;
    }
    return false;
  };
  Surface bad = two_triangles();
  bad.triangles(0, 1) = 4;
  EXPECT_TRUE(refuses(bad, {}, "triangle 1 names node 4, expected 0 to 3"));
  bad.triangles(0, 1) = 2;
  EXPECT_TRUE(refuses(bad, {}, "triangle 1 names a node twice"));
  bad = two_triangles();
  bad.positions.col(3) = bad.positions.col(1);
  EXPECT_TRUE(refuses(bad, {}, "triangle 1 has an area of 0"));
  bad = two_triangles();
  bad.positions(0, 2) = std::nan("");
  EXPECT_TRUE(refuses(bad, {}, "the position of node 2 is not finite"));
  bad = two_triangles();
  std::swap(bad.triangles(0, 1), bad.triangles(1, 1));
  EXPECT_TRUE(refuses(bad, {}, "run the same way along the edge"));
  bad = two_triangles();
  bad.positions.conservativeResize(3, 5);
  bad.positions.col(4).setOnes();
  EXPECT_TRUE(refuses(bad, {}, "node 4 belongs to no triangle"));
  bad = two_triangles();
  bad.triangles.conservativeResize(3, 0);
  EXPECT_TRUE(refuses(bad, {}, "no triangle"));
  EXPECT_TRUE(refuses(two_triangles(), {.total_mass = 0.0}, "total_mass"));
  EXPECT_TRUE(refuses(two_triangles(), {.center_mass_share = 1.0}, "center_mass_share"));
}

TEST(Texture, AGridHasTheWholePicture) {
  const ClothMesh mesh = make_cloth_grid({.nodes = {5, 3}});
  EXPECT_EQ(mesh.texture_coordinates.col(0), Eigen::Vector2d(0, 0));
  EXPECT_EQ(mesh.texture_coordinates.col(4), Eigen::Vector2d(1, 0));
  EXPECT_EQ(mesh.texture_coordinates.col(6), Eigen::Vector2d(0.25, 0.5));
  EXPECT_EQ(mesh.texture_coordinates.col(14), Eigen::Vector2d(1, 1));
  const Matrix2X<double> corners = corner_coordinates(mesh);
  ASSERT_EQ(corners.cols(), 3 * mesh.triangles.cols());
  EXPECT_EQ(corners.col(4), mesh.texture_coordinates.col(mesh.triangles(1, 1)));
}

// Recordings name nodes by number, so that the numbers must not depend on the compiler.
TEST(Icosphere, NodesAreNumberedAlikeByEveryCompiler) {
  const ClothMesh mesh = make_icosphere({.frequency = 2});
  const Triangles begin = mesh.triangles.leftCols(4);
  Triangles expected(3, 4);
  expected << 2, 1, 0, 1,  //
      1, 3, 3, 5,          //
      0, 0, 4, 3;
  EXPECT_EQ(begin, expected) << begin;
}

TEST(Texture, OfASphereIsNeverTornByTheSeam) {
  // Three divisions put nodes on the seam, four also on it; poles are nodes of even ones.
  for (const int frequency : {1, 2, 3, 4, 6}) {
    const ClothMesh mesh = make_icosphere({.frequency = frequency});
    const Matrix2X<double> corners = corner_coordinates(mesh);
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      const auto u = corners.block(0, 3 * t, 1, 3);
      EXPECT_LE(u.maxCoeff() - u.minCoeff(), 0.5 + 1e-12) << "triangle " << t;
    }
    EXPECT_GE(corners.minCoeff(), 0.0);
    EXPECT_LE(corners.row(1).maxCoeff(), 1.0);
    EXPECT_LT(corners.row(0).maxCoeff(), 1.5);
  }
  // Front to the right is counter-clockwise seen from above, so that letters are not mirrored.
  const ClothMesh turned = make_icosphere(
      {.frequency = 2,
       .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vector3<double>::UnitY()))});
  const ClothMesh straight = make_icosphere({.frequency = 2});
  EXPECT_EQ(turned.corner_texture_coordinates, straight.corner_texture_coordinates)
      << "the picture turns with the body";
}

TEST(Rope, IsALineOfNodesWithItsMassBetweenItsEnds) {
  const ClothMesh mesh =
      make_rope({.nodes = 5, .start = {0, 1, 0}, .end = {2, 1, 0}, .total_mass = 0.8});
  EXPECT_EQ(mesh.rest_positions.col(0), Vector3<double>(0, 1, 0));
  EXPECT_EQ(mesh.rest_positions.col(1), Vector3<double>(0.5, 1, 0));
  EXPECT_EQ(mesh.rest_positions.col(4), Vector3<double>(2, 1, 0));
  EXPECT_EQ(mesh.triangles.cols(), 0);
  EXPECT_EQ(mesh.edges_of({"stretch"}).cols(), 4);
  EXPECT_EQ(mesh.edges_of({"bend"}).cols(), 3);
  ASSERT_EQ(mesh.line_sets.size(), 1U);
  EXPECT_EQ(mesh.line_sets[0].triples.col(2), Eigen::Vector3i(2, 3, 4));
  EXPECT_NEAR(mesh.masses.sum(), 0.8, kBodySourcesRoundoff);
  EXPECT_NEAR(mesh.masses[0], 0.1, kBodySourcesRoundoff);
  EXPECT_NEAR(mesh.masses[2], 0.2, kBodySourcesRoundoff);
  const ClothMesh shortest = make_rope({.nodes = 2});
  EXPECT_EQ(shortest.edges_of({"bend"}).cols(), 0);
  EXPECT_THROW((void)make_rope({.nodes = 1}), InvalidArgument);
  EXPECT_THROW((void)make_rope({.nodes = 3, .start = {1, 0, 0}}), InvalidArgument);
}

}  // namespace
}  // namespace weft
