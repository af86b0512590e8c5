#include <weft/playback/rendering/meshes/cloth_drawing.hpp>

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include <weft/mesh/cutting/tear.hpp>
#include <weft/mesh/icosphere.hpp>
#include <weft/scenes/cloth_tear.hpp>

#include "tests/playback/rendering/small_scene.hpp"

namespace weft::scenes {
namespace {

/// A cube of 10 cm whose corners are single nodes.
Surface cube() {
  Surface surface;
  surface.positions.resize(3, 8);
  for (int v = 0; v < 8; ++v)
    surface.positions.col(v) << 0.1 * (v & 1), 0.1 * (v / 2 & 1), 0.1 * (v / 4);
  surface.triangles.resize(3, 12);
  surface.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                   //
      3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  return surface;
}

TEST(DrawnLayout, EdgesOfACubeAreCreasesAndABallIsRound) {
  const DrawnLayout sharp = make_drawn_layout(cube());
  EXPECT_TRUE(sharp.is_closed);
  EXPECT_EQ(sharp.mesh.positions.cols(), 24);
  for (Eigen::Index t = 0; t < sharp.mesh.triangles.cols(); ++t) {
    const Matrix3<double> x = sharp.mesh.positions(Eigen::all, sharp.mesh.triangles.col(t));
    const Vector3<double> normal = Vector3<double>(x.col(1) - x.col(0))
                                       .cross(Vector3<double>(x.col(2) - x.col(0)))
                                       .normalized();
    for (const int v : sharp.mesh.triangles.col(t)) {
      EXPECT_NEAR(normal.dot(sharp.mesh.normals.col(v)), 1, 1e-14);
    }
  }
  const ClothMesh ball = make_icosphere({.radius = 0.3, .frequency = 3});
  const DrawnLayout round = make_drawn_layout({ball.rest_positions, ball.triangles});
  EXPECT_EQ(round.mesh.positions.cols(), ball.rest_positions.cols());
}

TEST(DrawnLayout, ASeamOfTheTexturePartsVerticesAndNotNormals) {
  const ClothMesh ball = make_icosphere({.radius = 0.3, .frequency = 3});
  const DrawnLayout layout =
      make_drawn_layout({ball.rest_positions, ball.triangles, {}, ball.corner_texture_coordinates});
  EXPECT_TRUE(layout.has_coordinates);
  EXPECT_GT(layout.mesh.positions.cols(), ball.rest_positions.cols());
  for (Eigen::Index v = 0; v < layout.mesh.positions.cols(); ++v) {
    const double facing = layout.mesh.normals.col(v).dot(layout.mesh.positions.col(v).normalized());
    EXPECT_GT(facing, 0.98);
  }
}

/// The cloth of the small scene with a drawn sheet 10 cm above it, 61 x 61 vertices.
Scene drawn_scene() {
  Scene scene = small_scene();
  const ClothMesh grid =
      make_cloth_grid({.nodes = {61, 61}, .size = {1.98, 1.98}, .center = {0, 2.6, 0}});
  scene.cloths[0].drawn_mesh =
      DrawnCloth{std::make_shared<const Surface>(Surface{grid.rest_positions, grid.triangles})};
  return scene;
}

TEST(ClothDrawing, LeavesOutWhatIsNotFinite) {
  const Scene scene = drawn_scene();
  SceneState state = rest_state(scene);
  ClothDrawing drawing(*scene.cloths[0].drawn_mesh, make_mesh(scene.cloths[0]));
  EXPECT_EQ(drawn_surface(drawing, state.cloths[0], {}).indices.size(), 3U * 7200);
  state.cloths[0].positions(0, 0) = std::numeric_limits<double>::quiet_NaN();
  const SurfaceMesh mesh = drawn_surface(drawing, state.cloths[0], {});
  EXPECT_LT(mesh.indices.size(), 3U * 7200);
  EXPECT_GT(mesh.indices.size(), 3U * 6000);
  for (const SurfaceVertex& vertex : mesh.vertices) EXPECT_TRUE(vertex.position.allFinite());
}

TEST(ClothDrawing, FollowsATearAndItsEnd) {
  const Scene scene = drawn_scene();
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  ClothDrawing drawing(*scene.cloths[0].drawn_mesh, mesh);
  Edges cut(2, 8);
  for (int j = 0; j < 8; ++j) cut.col(j) << 9 * j + 4, 9 * (j + 1) + 4;
  const Tear tear = cut_along(mesh, cut);
  ClothState torn{
      "cloth", tear.mesh.rest_positions, tear.mesh.rest_positions,
      std::make_shared<const ClothTopology>(ClothTopology{tear.mesh.triangles, tear.origins})};
  const std::size_t whole = drawn_surface(drawing, rest_state(scene).cloths[0], {}).vertices.size();
  const SurfaceMesh mesh_of_torn = drawn_surface(drawing, torn, {});
  EXPECT_GT(mesh_of_torn.vertices.size(), whole);
  EXPECT_EQ(mesh_of_torn.indices.size(), 3U * 7200);
  EXPECT_EQ(drawn_surface(drawing, rest_state(scene).cloths[0], {}).vertices.size(), whole);
}

// The drawn sheet covers the background above the cloth's own edge; strains are those of the cloth itself.
TEST(ClothDrawing, PicturesShowTheDrawnMesh) {
  Scene scene = drawn_scene();
  scene.cloths[0].appearance.color = parse_color("red");
  const SceneState state = rest_state(scene);
  Camera side = scene.camera;
  side.position = {0, 2.55, 10};
  side.target = {0, 2.55, 0};
  RenderOptions options = small_options();
  options.camera = side;
  Renderer renderer(scene);
  const Image drawn = renderer.render(state, options);
  scene.cloths[0].drawn_mesh.reset();
  Renderer plain(scene);
  const Image bare = plain.render(state, options);
  EXPECT_NE(drawn.rgb, bare.rgb);
  options.style = SurfaceStyle::kWireframe;
  EXPECT_EQ(renderer.render(state, options).rgb, plain.render(state, options).rgb);
}

}  // namespace
}  // namespace weft::scenes
