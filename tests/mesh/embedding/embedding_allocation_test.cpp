// A pose and its vertices allocate nothing.
#include <gtest/gtest.h>

#include <weft/mesh/icosphere.hpp>

#include "embedding_samples.hpp"
#include "tests/support/allocation_counter.hpp"

namespace weft {
namespace {

TEST(EmbeddingAllocation, IsZeroForEveryFrame) {
  const ClothMesh cloth = coarse_cloth();
  DrawnMesh drawn = fine_sheet(40, 0.5, 0.01);
  const auto num = static_cast<int>(drawn.positions.cols());
  // A button beside the sheet: rigid pieces are placed in every pose, too.
  drawn.positions.conservativeResize(3, num + 3);
  drawn.positions.rightCols(3) << 0, 0.01, 0, 0.02, 0.02, 0.02, 0, 0, 0.01;
  drawn.triangles.conservativeResize(3, drawn.triangles.cols() + 1);
  drawn.triangles.rightCols(1) << num, num + 1, num + 2;
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, drawn,
                                 {.rigid_pieces = 0.05});
  ASSERT_EQ(embedding.report().num_rigid_pieces, 1);
  ClothPose pose = embedding.make_pose();
  const Matrix3X<double> positions = bent(cloth.rest_positions, 0.3);
  Vector3<double> sum(0, 0, 0);
  const long before = test::num_allocations();
  embedding.set_pose(positions, pose);
  for (int v = 0; v < embedding.num_vertices(); ++v) sum += embedding.vertex(pose, v).position;
  EXPECT_EQ(test::num_allocations() - before, 0);
  EXPECT_TRUE(sum.allFinite());
}

TEST(EmbeddingAllocation, TheCounterSeesTheConstructor) {
  const ClothMesh cloth = coarse_cloth();
  const DrawnMesh drawn = fine_sheet(3, 0.4, 0.0);
  const long before = test::num_allocations();
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, drawn);
  EXPECT_GT(test::num_allocations() - before, 10);
}

}  // namespace
}  // namespace weft
