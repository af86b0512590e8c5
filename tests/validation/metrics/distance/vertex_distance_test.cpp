#include <gtest/gtest.h>

#include <Eigen/LU>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/distance/vertex_distance.hpp>

#include "tests/validation/metrics/test_shapes.hpp"

namespace weft::validation {
namespace {

VectorX<double> equal_weights(Eigen::Index n) {
  return VectorX<double>::Ones(n);
}

RigidMotion some_motion() {
  return {Eigen::AngleAxisd(2.1, Vector3<double>(1, -2, 0.5).normalized()).toRotationMatrix(),
          {3.0, -1.0, 0.25}};
}

TEST(VertexDistance, OfATranslationIsItsLength) {
  const ClothMesh mesh = flat_cloth(5, 2.0);
  const Matrix3X<double> moved = mesh.rest_positions.colwise() + Vector3<double>(0.3, 0, 0.4);
  const VertexDistance d = vertex_distance(mesh.rest_positions, moved, node_weights(mesh));
  EXPECT_NEAR(d.rms, 0.5, kRoundoff);
  EXPECT_NEAR(d.largest, 0.5, kRoundoff);
  EXPECT_NEAR(d.rms_relative_to(2.0), 0.25, kRoundoff);
  EXPECT_FALSE(d.first_non_finite_node);
}

TEST(VertexDistance, WeighsNodesByTheirArea) {
  const Matrix3X<double> a = Matrix3X<double>::Zero(3, 2);
  Matrix3X<double> b = a;
  b(1, 0) = 3.0;
  b(2, 1) = 4.0;
  // sqrt((1 * 9 + 3 * 16) / 4)
  const VertexDistance d = vertex_distance(a, b, VectorX<double>{{1.0, 3.0}});
  EXPECT_NEAR(d.rms, std::sqrt(57.0 / 4.0), kRoundoff);
  EXPECT_EQ(d.largest, 4.0);
  EXPECT_EQ(d.largest_node, 1);
}

TEST(VertexDistance, WeightsAreSharesOfTheRestArea) {
  const ClothMesh mesh =
      flat_cloth(3, 2.0);  // four cells of 1 m^2; the inner node touches all 8 triangles
  const VectorX<double> weights = node_weights(mesh);
  EXPECT_NEAR(weights.sum(), 1.0, kRoundoff);
  EXPECT_NEAR(weights[4], 8.0 * (0.5 / 3.0) / 4.0, kRoundoff);
  ClothMesh rope = mesh;
  rope.triangles.resize(3, 0);
  EXPECT_EQ(node_weights(rope)[7], 1.0 / 9.0);
}

TEST(VertexDistance, AlignedIgnoresRigidMotionAndPlainDoesNot) {
  const Matrix3X<double> a = Sequence(1).columns(20);
  const Matrix3X<double> b = some_motion().apply(a);
  const VertexDistance aligned = aligned_vertex_distance(a, b, equal_weights(20));
  EXPECT_LT(aligned.largest, kRoundoff);
  EXPECT_GT(vertex_distance(a, b, equal_weights(20)).rms, 1.0);
  const RigidMotion motion = best_rigid_motion(a, b, equal_weights(20));
  EXPECT_LT((motion.rotation - some_motion().rotation).norm(), kRoundoff);
  EXPECT_LT((motion.translation - some_motion().translation).norm(), kRoundoff);
}

TEST(VertexDistance, AlignmentNeverReflects) {
  const Matrix3X<double> a = Sequence(2).columns(12);
  Matrix3X<double> mirrored = a;
  mirrored.row(0) *= -1.0;
  const RigidMotion motion = best_rigid_motion(a, mirrored, equal_weights(12));
  EXPECT_NEAR(motion.rotation.determinant(), 1.0, kRoundoff);
  // A mirror image of a solid shape is another shape.
  EXPECT_GT(aligned_vertex_distance(a, mirrored, equal_weights(12)).rms, 0.1);
}

TEST(VertexDistance, AlignmentBeatsEveryNeighboringMotion) {
  const Matrix3X<double> a = Sequence(3).columns(15);
  const Matrix3X<double> b = some_motion().apply(a) + 0.2 * Sequence(4).columns(15);
  const VectorX<double> weights =
      Sequence(5).columns(5).reshaped<Eigen::RowMajor>().array() + 1.5;  // 0.5 to 2.5
  const RigidMotion best = best_rigid_motion(a, b, weights);
  const double best_rms = vertex_distance(best.apply(a), b, weights).rms;
  Sequence directions(6);
  for (int trial = 0; trial < 50; ++trial) {
    RigidMotion other = best;
    other.rotation = Eigen::AngleAxisd(1e-3, directions.vector().normalized()).toRotationMatrix() *
                     best.rotation;
    other.translation += 1e-3 * directions.vector();
    EXPECT_GT(vertex_distance(other.apply(a), b, weights).rms, best_rms);
  }
}

TEST(VertexDistance, AlignsFlatShapesLinesAndPoints) {
  Matrix3X<double> flat = Sequence(7).columns(10);
  flat.row(1).setZero();
  Matrix3X<double> line = flat;
  line.row(2).setZero();
  const Matrix3X<double> point = Vector3<double>(1, 2, 3).replicate(1, 10);
  for (const Matrix3X<double>& shape : {flat, line, point}) {
    const Matrix3X<double> moved = some_motion().apply(shape);
    EXPECT_LT(aligned_vertex_distance(shape, moved, equal_weights(10)).largest, kRoundoff);
    const RigidMotion motion = best_rigid_motion(shape, moved, equal_weights(10));
    EXPECT_NEAR(motion.rotation.determinant(), 1.0, kRoundoff);
  }
  const Matrix3X<double> one = Vector3<double>(1, 2, 3);
  EXPECT_LT(aligned_vertex_distance(one, one * 5.0, equal_weights(1)).largest, kRoundoff);
}

TEST(VertexDistance, NonFiniteInputIsNamedAndNeverSmall) {
  const Matrix3X<double> a = Matrix3X<double>::Zero(3, 4);
  for (const double bad : {kNaN, kInfinity}) {
    Matrix3X<double> b = a;
    b(1, 2) = bad;
    for (const VertexDistance& d : {vertex_distance(a, b, VectorX<double>{{1, 1, 0, 1}}),
                                    aligned_vertex_distance(b, a, equal_weights(4)),
                                    vertex_distance(b, b, equal_weights(4))}) {
      EXPECT_TRUE(std::isnan(d.rms));
      EXPECT_TRUE(std::isnan(d.largest));
      EXPECT_EQ(d.first_non_finite_node, 2);
      EXPECT_EQ(d.largest_node, 2);
    }
    EXPECT_TRUE(best_rigid_motion(a, b, equal_weights(4)).rotation.hasNaN());
  }
}

TEST(VertexDistance, RefusesShapesWeightsAndLengthsThatDoNotFit) {
  const Matrix3X<double> four = Matrix3X<double>::Zero(3, 4);
  const Matrix3X<double> none(3, 0);
  EXPECT_THROW((void)node_distances(four, four.leftCols(3)), InvalidArgument);
  EXPECT_THROW((void)node_distances(none, none), InvalidArgument);
  EXPECT_THROW((void)vertex_distance(four, four, equal_weights(3)), InvalidArgument);
  EXPECT_THROW((void)vertex_distance(four, four, VectorX<double>::Zero(4)), InvalidArgument);
  EXPECT_THROW((void)vertex_distance(four, four, VectorX<double>{{1, 1, -1, 1}}), InvalidArgument);
  EXPECT_THROW((void)vertex_distance(four, four, VectorX<double>{{1, 1, kNaN, 1}}),
               InvalidArgument);
  EXPECT_THROW((void)VertexDistance{}.rms_relative_to(0.0), InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
