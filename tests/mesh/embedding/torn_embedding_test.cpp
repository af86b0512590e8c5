#include <set>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/mesh/cutting/tear.hpp>

#include "embedding_samples.hpp"

namespace weft {
namespace {

/// The edges of the cloth's middle line x = 0.
Edges middle_line() {
  Edges cut(2, 10);
  for (int j = 0; j < 10; ++j) cut.col(j) << 11 * j + 5, 11 * (j + 1) + 5;
  return cut;
}

class TornEmbedding : public ::testing::Test {
 protected:
  TornEmbedding() : tear_(cut_along(cloth_, middle_line())) {
    embedding_.follow_tear(tear_.mesh.triangles, tear_.mesh.num_nodes());
  }

  ClothMesh cloth_ = coarse_cloth();
  DrawnMesh sheet_ = fine_sheet(38, 0.49, 0.01);
  ClothEmbedding embedding_{cloth_.rest_positions, cloth_.triangles, sheet_};
  Tear tear_;
};

TEST_F(TornEmbedding, AtRestNothingMovesAndCopiesLieOnTheirOriginals) {
  ASSERT_TRUE(tear_.any());
  ASSERT_GT(embedding_.num_vertices(), sheet_.positions.cols());
  const ClothPose pose = pose_of(embedding_, tear_.mesh.rest_positions);
  for (int v = 0; v < embedding_.num_vertices(); ++v) {
    const Vector3<double> rest = sheet_.positions.col(embedding_.original(v));
    EXPECT_LT((embedding_.vertex(pose, v).position - rest).norm(), 1e-14) << v;
  }
}

// The halves go apart by 1 m: no drawn triangle may reach across.
TEST_F(TornEmbedding, DrawnTrianglesPartWithTheCloth) {
  Matrix3X<double> apart = tear_.mesh.rest_positions;
  std::set<int> right;
  for (Eigen::Index t = 0; t < cloth_.triangles.cols(); ++t) {
    const auto places = cloth_.rest_positions(0, cloth_.triangles.col(t));
    if (places.mean() < 0) continue;
    for (const int node : tear_.mesh.triangles.col(t)) right.insert(node);
  }
  for (const int node : right) apart(0, node) += 1;
  const ClothPose pose = pose_of(embedding_, apart);
  const Matrix3X<double> drawn = drawn_positions(embedding_, pose);
  int num_left = 0;
  for (Eigen::Index t = 0; t < embedding_.drawn_triangles().cols(); ++t) {
    const auto x = drawn(0, embedding_.drawn_triangles().col(t));
    EXPECT_LT(x.maxCoeff() - x.minCoeff(), 0.03) << t;
    if (x.mean() < 0.5) ++num_left;
  }
  EXPECT_GT(num_left, 0.45 * static_cast<double>(embedding_.drawn_triangles().cols()));
  EXPECT_EQ(embedding_.drawn_triangles().cols(), sheet_.triangles.cols());
}

TEST_F(TornEmbedding, AWholeClothIsAsIfItHadNeverTorn) {
  embedding_.follow_tear(cloth_.triangles, cloth_.num_nodes());
  EXPECT_EQ(embedding_.num_vertices(), sheet_.positions.cols());
  EXPECT_EQ(embedding_.drawn_triangles(), sheet_.triangles);
}

TEST_F(TornEmbedding, RefusesTrianglesOfAnotherCloth) {
  EXPECT_THROW(embedding_.follow_tear(cloth_.triangles.leftCols(3), cloth_.num_nodes()),
               InvalidArgument);
  EXPECT_THROW(embedding_.follow_tear(cloth_.triangles, 50), InvalidArgument);
}

}  // namespace
}  // namespace weft
