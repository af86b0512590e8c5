#include <weft/fast_solver/network/element_stiffness.hpp>

#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

constexpr int kNumNodes = 11;
constexpr int kNumRows = 16;  // with padding
/// Sums of a few dozen products of numbers up to 1.
constexpr float kRounding = 100 * std::numeric_limits<float>::epsilon();

ElementStiffness::Elements elements() {
  ElementStiffness::Elements nodes(4, 5);
  nodes << 0, 1, 9, 4, 10,  //
      1, 2, 1, 5, 0,        //
      2, 3, 0, 6, 4,        //
      3, 4, 8, 7, 2;        //
  return nodes;
}

ElementStiffness with_gradients() {
  std::srand(1);
  ElementStiffness stiffness;
  stiffness.set_elements(elements(), kNumNodes);
  stiffness.gradients().setRandom();
  return stiffness;
}

/// The sum of g g^T, by nodes and axes.
Eigen::MatrixXf dense(ElementStiffness& stiffness) {
  Eigen::MatrixXf rows = Eigen::MatrixXf::Zero(elements().cols(), 3 * kNumNodes);
  for (Eigen::Index e = 0; e < elements().cols(); ++e) {
    for (int corner = 0; corner < 4; ++corner) {
      rows.row(e).segment<3>(3 * elements()(corner, e)) +=
          stiffness.gradients().col(e).segment<3>(3 * corner);
    }
  }
  return rows.transpose() * rows;
}

void add_products(ElementStiffness& stiffness, int num_parts,
                  const NodeArrays<float>& displacements, NodeArrays<float>& product) {
  for (int part = 0; part < num_parts; ++part) {
    stiffness.find_strains(part, num_parts, displacements);
  }
  stiffness.add_products({0, 8}, product);
  stiffness.add_products({8, kNumRows}, product);
}

TEST(ElementStiffness, ProductsAreThoseOfTheSumOfSquares) {
  ElementStiffness stiffness = with_gradients();
  NodeArrays<float> displacements = NodeArrays<float>::Random(kNumRows, 3);
  for (const int num_parts : {1, 3, 8}) {
    NodeArrays<float> product = NodeArrays<float>::Ones(kNumRows, 3);
    add_products(stiffness, num_parts, displacements, product);
    const Matrix3X<float> given = displacements.topRows(kNumNodes).transpose();
    const Eigen::VectorXf expected = dense(stiffness) * given.reshaped();
    const Matrix3X<float> found = product.topRows(kNumNodes).transpose();
    EXPECT_LT(((found.reshaped() - expected).array() - 1).abs().maxCoeff(), kRounding);
    EXPECT_EQ(product.bottomRows(kNumRows - kNumNodes).minCoeff(), 1) << "padding is no node";
  }
}

TEST(ElementStiffness, BlocksAreThoseOfTheDiagonal) {
  ElementStiffness stiffness = with_gradients();
  BlockArrays blocks = BlockArrays::Zero(kNumRows, 6);
  stiffness.add_blocks({0, kNumRows}, blocks);
  const Eigen::MatrixXf matrix = dense(stiffness);
  for (int node = 0; node < kNumNodes; ++node) {
    const Eigen::Matrix3f block = matrix.block<3, 3>(3 * node, 3 * node);
    const Eigen::Matrix<float, 6, 1> expected(block(0, 0), block(1, 1), block(2, 2), block(0, 1),
                                              block(1, 2), block(2, 0));
    EXPECT_LT((blocks.row(node).transpose() - expected).cwiseAbs().maxCoeff(), kRounding) << node;
  }
}

TEST(ElementStiffness, TakesOtherElements) {
  ElementStiffness stiffness = with_gradients();
  stiffness.set_elements(elements().leftCols(2), kNumNodes);
  ASSERT_EQ(stiffness.gradients().cols(), 2);
  stiffness.gradients().setOnes();
  BlockArrays blocks = BlockArrays::Zero(kNumRows, 6);
  stiffness.add_blocks({0, kNumRows}, blocks);
  EXPECT_EQ(blocks.col(0).sum(), 8) << "two elements of four corners";
}

}  // namespace
}  // namespace weft::fast
