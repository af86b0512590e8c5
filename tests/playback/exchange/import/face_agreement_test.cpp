#include <weft/playback/exchange/import/face_agreement.hpp>

#include <gtest/gtest.h>

#include <weft/mesh/cloth_grid.hpp>

namespace weft::scenes {
namespace {

using Faces = std::vector<std::vector<int>>;

ClothMesh grid() {
  return make_cloth_grid({.nodes = {3, 3}, .size = {1.0, 1.0}, .total_mass = 1.0});
}

Faces triangles_of(const ClothMesh& mesh) {
  Faces faces;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    faces.push_back({mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)});
  }
  return faces;
}

TEST(FaceAgreement, TakesTheMeshesOwnTrianglesInAnyOrderAndTurn) {
  const ClothMesh mesh = grid();
  Faces faces = triangles_of(mesh);
  EXPECT_FALSE(face_disagreement(mesh, faces));
  std::reverse(faces.begin(), faces.end());
  for (std::vector<int>& face : faces) std::reverse(face.begin(), face.end());
  EXPECT_FALSE(face_disagreement(mesh, faces));
}

TEST(FaceAgreement, TakesTheCellsOfAGrid) {
  const ClothMesh mesh = grid();
  const Faces cells{{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}};
  EXPECT_FALSE(face_disagreement(mesh, cells));
}

TEST(FaceAgreement, FindsNodesThatHaveChangedPlaces) {
  const ClothMesh mesh = grid();
  Faces middle = triangles_of(mesh);
  for (std::vector<int>& face : middle) {
    for (int& node : face) node = node == 0 ? 4 : node == 4 ? 0 : node;
  }
  EXPECT_TRUE(face_disagreement(mesh, middle));
}

TEST(FaceAgreement, FindsMissingAndOtherFaces) {
  const ClothMesh mesh = grid();
  Faces faces = triangles_of(mesh);
  faces.pop_back();
  EXPECT_EQ(*face_disagreement(mesh, faces), "the faces are 7 triangles, expected 8");
  faces.push_back({0, 4, 8});
  EXPECT_TRUE(face_disagreement(mesh, faces));
}

}  // namespace
}  // namespace weft::scenes
