#include <weft/mesh/embedding/cloth_embedding.hpp>

#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/mesh/embedding/connected_pieces.hpp>
#include <weft/mesh/icosphere.hpp>

#include "embedding_samples.hpp"

namespace weft {
namespace {

/// Rounding of some tens of operations on lengths of about 1 m.
constexpr double kEmbeddingRounding = 1e-14;

/// Points around a coarse ball, up to 5 cm off its surface of radius 0.5 m, with random directions for normals and tangents.
DrawnMesh cloud_around_ball(int num_points) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> offset(-0.05, 0.05);
  const auto direction = [&] {
    return Vector3<double>(gauss(random), gauss(random), gauss(random)).normalized();
  };
  DrawnMesh cloud;
  cloud.positions.resize(3, num_points);
  cloud.normals.resize(3, num_points);
  cloud.tangents.resize(3, num_points);
  cloud.triangles.resize(3, num_points - 2);
  for (int v = 0; v < num_points; ++v) {
    cloud.positions.col(v) = (0.5 + offset(random)) * direction();
    cloud.normals.col(v) = direction();
    cloud.tangents.col(v) = direction();
    if (v >= 2) cloud.triangles.col(v - 2) << v - 2, v - 1, v;
  }
  return cloud;
}

ClothMesh coarse_ball() {
  return make_icosphere({.radius = 0.5, .frequency = 4});
}

TEST(ClothEmbedding, AtRestEveryVertexIsWhereTheDrawnMeshHasIt) {
  const ClothMesh ball = coarse_ball();
  const DrawnMesh cloud = cloud_around_ball(2000);
  const ClothEmbedding embedding(ball.rest_positions, ball.triangles, cloud);
  const ClothPose pose = pose_of(embedding, ball.rest_positions);
  for (int v = 0; v < embedding.num_vertices(); ++v) {
    const DrawnVertex vertex = embedding.vertex(pose, v);
    EXPECT_LT((vertex.position - cloud.positions.col(v)).norm(), kEmbeddingRounding) << v;
    EXPECT_LT((vertex.normal - cloud.normals.col(v)).norm(), kEmbeddingRounding) << v;
    EXPECT_LT((vertex.tangent - cloud.tangents.col(v)).norm(), kEmbeddingRounding) << v;
  }
}

TEST(ClothEmbedding, RigidMotionMovesEveryVertexAsTheBody) {
  const ClothMesh ball = coarse_ball();
  const DrawnMesh cloud = cloud_around_ball(2000);
  const ClothEmbedding embedding(ball.rest_positions, ball.triangles, cloud,
                                 {.rigid_pieces = 0.02});
  const Matrix3<double> turn =
      Eigen::AngleAxisd(2.1, Vector3<double>(1, -2, 0.5).normalized()).toRotationMatrix();
  const Vector3<double> shift(0.3, -1.2, 0.8);
  const Matrix3X<double> moved = (turn * ball.rest_positions).colwise() + shift;
  const ClothPose pose = pose_of(embedding, moved);
  for (int v = 0; v < embedding.num_vertices(); ++v) {
    const DrawnVertex vertex = embedding.vertex(pose, v);
    EXPECT_LT((vertex.position - turn * cloud.positions.col(v) - shift).norm(), kEmbeddingRounding)
        << v;
    EXPECT_LT((vertex.normal - turn * cloud.normals.col(v)).norm(), kEmbeddingRounding) << v;
    EXPECT_LT((vertex.tangent - turn * cloud.tangents.col(v)).norm(), kEmbeddingRounding) << v;
  }
}

TEST(ClothEmbedding, StretchInThePlaneIsExactAndKeepsTheThickness) {
  const ClothMesh cloth = coarse_cloth();
  const DrawnMesh sheet = fine_sheet(40, 0.49, 0.01);
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, sheet);
  Matrix3<double> stretch = Matrix3<double>::Identity();
  stretch(0, 0) = 1.3;
  stretch(2, 2) = 0.8;
  stretch(0, 2) = 0.25;
  const ClothPose pose = pose_of(embedding, stretch * cloth.rest_positions);
  for (int v = 0; v < embedding.num_vertices(); ++v) {
    EXPECT_LT((embedding.vertex(pose, v).position - stretch * sheet.positions.col(v)).norm(),
              kEmbeddingRounding);
  }
}

/// Largest distance of what is drawn from the bent sheet, of vertices that are inside by two cells: the frames of border nodes are one-sided.
double cylinder_error(int nodes, double radius, double height, double& normal_error) {
  const ClothMesh cloth = make_cloth_grid({.nodes = {nodes, nodes}, .size = {1.0, 1.0}});
  const DrawnMesh sheet = fine_sheet(67, 0.5 - 2.0 / (nodes - 1), height);
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, sheet);
  const ClothPose pose = pose_of(embedding, bent(cloth.rest_positions, radius));
  double error = 0;
  normal_error = 0;
  for (int v = 0; v < embedding.num_vertices(); ++v) {
    const Vector3<double> rest = sheet.positions.col(v);
    const DrawnVertex vertex = embedding.vertex(pose, v);
    error = std::max(error, (vertex.position - on_cylinder(rest, radius)).norm());
    const double angle = rest.x() / radius;
    const Vector3<double> normal(-std::sin(angle), std::cos(angle), 0);
    normal_error = std::max(normal_error, std::acos(std::min(1.0, vertex.normal.dot(normal))));
  }
  return error;
}

// Between nodes the chord of a cylinder dips by h^2 / (8 r): 6.25 mm for r = 0.2 m and h = 0.1 m. What is drawn
// must leave a small part of it, and must converge with a higher order than a polyhedron, which has 2.
TEST(ClothEmbedding, CylinderIsRoundNotFaceted) {
  double normal_error = 0;
  const double chord = 0.1 * 0.1 / (8 * 0.2);
  const double coarse = cylinder_error(11, 0.2, 0.0, normal_error);
  EXPECT_LT(coarse, 0.25 * chord);
  EXPECT_LT(normal_error, 0.03);  // [rad]; of a facet: h / (2 r) = 0.25
  const double fine = cylinder_error(21, 0.2, 0.0, normal_error);
  EXPECT_GT(std::log2(coarse / fine), 2.7);
  EXPECT_LT(normal_error, 0.01);
}

TEST(ClothEmbedding, LayersKeepTheirDistanceOnACylinder) {
  double normal_error = 0;
  for (const double height : {0.02, -0.02}) {
    EXPECT_LT(cylinder_error(11, 0.2, height, normal_error), 2.5e-3);
    EXPECT_LT(normal_error, 0.03);
  }
}

// A fold of radius 6 cm, a node every 29 degrees: layers 1 cm to both sides keep their order and their fronts.
TEST(ClothEmbedding, LayersDoNotTurnOverInAFold) {
  const double radius = 0.06;
  const ClothMesh cloth = make_cloth_grid({.nodes = {34, 5}, .size = {1.0, 0.15}});
  Matrix3X<double> folded = cloth.rest_positions;
  for (Eigen::Index i = 0; i < folded.cols(); ++i) {
    const Vector3<double> rest = cloth.rest_positions.col(i);
    const double half = 0.5 * std::numbers::pi * radius;
    const double beyond = std::max(0.0, std::abs(rest.x()) - half);
    Vector3<double> place = on_cylinder({std::clamp(rest.x(), -half, half), 0, rest.z()}, radius);
    place.y() += beyond;
    folded.col(i) = place;
  }
  for (const double height : {0.01, -0.01}) {
    const ClothMesh fine =
        make_cloth_grid({.nodes = {200, 9}, .size = {0.99, 0.14}, .center = {0, height, 0}});
    const DrawnMesh layer{.positions = fine.rest_positions, .triangles = fine.triangles};
    const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, layer);
    const ClothPose pose = pose_of(embedding, folded);
    const Matrix3X<double> drawn = drawn_positions(embedding, pose);
    const Matrix3X<double> normals = surface_normals(drawn, layer.triangles);
    for (Eigen::Index t = 0; t < layer.triangles.cols(); ++t) {
      const Eigen::Vector3i corners = layer.triangles.col(t);
      const Vector3<double> normal = Vector3<double>(drawn.col(corners[1]) - drawn.col(corners[0]))
                                         .cross(drawn.col(corners[2]) - drawn.col(corners[0]));
      for (const int vertex : corners) {
        EXPECT_GT(normal.normalized().dot(embedding.vertex(pose, vertex).normal), 0.95);
      }
    }
    // The layer inside the bend is nearer to its axis than the cloth, the one outside farther.
    const Vector3<double> axis(0, radius, 0);
    const auto at_bottom = static_cast<Eigen::Index>(4 * 200 + 100);
    const double distance = (drawn.col(at_bottom) - axis).head<2>().norm();
    EXPECT_NEAR(distance, radius - height, 0.001);
  }
}

// Along a line that crosses edges of the cloth at all angles, above and below a crumpled surface: no jump.
TEST(ClothEmbedding, NothingJumpsAcrossEdges) {
  const ClothMesh ball = coarse_ball();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> offset(-0.04, 0.04);
  Matrix3X<double> crumpled = ball.rest_positions;
  for (double& x : crumpled.reshaped()) x += offset(random);
  constexpr int kSteps = 20000;
  for (const double distance : {0.46, 0.50, 0.54}) {
    DrawnMesh line;
    line.positions.resize(3, kSteps);
    line.normals.resize(3, kSteps);
    line.triangles.resize(3, 1);
    line.triangles << 0, 1, 2;
    for (int v = 0; v < kSteps; ++v) {
      const double angle = 2 * std::numbers::pi * v / kSteps;
      line.positions.col(v) =
          distance *
          Vector3<double>(std::cos(angle), std::sin(angle), 0.3 * std::sin(3 * angle)).normalized();
      line.normals.col(v) = line.positions.col(v).normalized();
    }
    const ClothEmbedding embedding(ball.rest_positions, ball.triangles, line);
    const ClothPose pose = pose_of(embedding, crumpled);
    for (int v = 1; v < kSteps; ++v) {
      const DrawnVertex before = embedding.vertex(pose, v - 1);
      const DrawnVertex after = embedding.vertex(pose, v);
      const double step = (line.positions.col(v) - line.positions.col(v - 1)).norm();
      EXPECT_LT((after.position - before.position).norm(), 6 * step) << v;
      EXPECT_LT((after.normal - before.normal).norm(), 60 * step)
          << v;  // step in [m], of a radius of 0.5
    }
  }
}

TEST(ClothEmbedding, ButtonsKeepTheirShapeAndTurnWithTheCloth) {
  const ClothMesh cloth = coarse_cloth();
  DrawnMesh button = fine_sheet(5, 0.01, 0.004);
  button.positions.row(0).array() += 0.13;
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, button,
                                 {.rigid_pieces = 0.03});
  ASSERT_EQ(embedding.report().num_rigid_pieces, 1);
  const ClothEmbedding bends(cloth.rest_positions, cloth.triangles, button);
  ASSERT_EQ(bends.report().num_rigid_pieces, 0);
  Matrix3X<double> stretched = bent(cloth.rest_positions, 0.3);
  stretched.row(2) *= 1.5;
  const Matrix3X<double> drawn = drawn_positions(embedding, pose_of(embedding, stretched));
  const Matrix3X<double> soft = drawn_positions(bends, pose_of(bends, stretched));
  const auto width = [](const Matrix3X<double>& p) { return (p.col(0) - p.col(20)).norm(); };
  EXPECT_NEAR(width(drawn), width(button.positions), kEmbeddingRounding);
  EXPECT_NEAR(width(soft), 1.5 * width(button.positions), 1e-6);
  // The middle of the piece is led as any vertex there.
  EXPECT_LT((drawn.col(12) - soft.col(12)).norm(), kEmbeddingRounding);
  EXPECT_LT((drawn.col(12) - on_cylinder({0.13, 0.004, 0}, 0.3)).norm(), 2e-3);
}

TEST(ClothEmbedding, VerticesOfOnePlaceStayTogether) {
  DrawnMesh seam = fine_sheet(30, 0.45, 0.005);
  const auto num = static_cast<int>(seam.positions.cols());
  seam.positions.conservativeResize(3, 2 * num);
  seam.positions.rightCols(num) = seam.positions.leftCols(num);
  for (Eigen::Index t = 0; t < seam.triangles.cols(); t += 2) seam.triangles.col(t).array() += num;
  EXPECT_EQ(connected_pieces(seam.positions, seam.triangles).size(), 1U);
  const ClothMesh cloth = coarse_cloth();
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, seam);
  const ClothPose pose = pose_of(embedding, bent(cloth.rest_positions, 0.25));
  for (int v = 0; v < num; ++v) {
    EXPECT_EQ(embedding.vertex(pose, v).position, embedding.vertex(pose, v + num).position);
    EXPECT_EQ(embedding.vertex(pose, v).normal, embedding.vertex(pose, v + num).normal);
  }
}

TEST(ClothEmbedding, AnyNumberOfThreadsGivesTheSameBits) {
  const ClothMesh cloth = coarse_cloth();
  const DrawnMesh sheet = fine_sheet(80, 0.5, 0.01);
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, sheet);
  const ClothPose pose = pose_of(embedding, bent(cloth.rest_positions, 0.2));
  const Matrix3X<double> serial = drawn_positions(embedding, pose);
  Matrix3X<double> parallel = Matrix3X<double>::Zero(3, embedding.num_vertices());
  std::vector<std::thread> threads;
  for (int part = 0; part < 4; ++part) {
    threads.emplace_back([&, part] {
      for (int v = part; v < embedding.num_vertices(); v += 4) {
        parallel.col(v) = embedding.vertex(pose, v).position;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(parallel, serial);
}

TEST(ClothEmbedding, ANodeThatIsNotFiniteShowsAndSpoilsOnlyItsNeighborhood) {
  const ClothMesh cloth = coarse_cloth();
  const DrawnMesh sheet = fine_sheet(40, 0.5, 0.01);
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, sheet);
  Matrix3X<double> broken = cloth.rest_positions;
  broken(1, 0) = std::numeric_limits<double>::quiet_NaN();
  const ClothPose pose = pose_of(embedding, broken);
  EXPECT_FALSE(embedding.vertex(pose, 0).position.allFinite());
  EXPECT_TRUE(embedding.vertex(pose, embedding.num_vertices() - 1).position.allFinite());
}

/// What the constructor says of a mistake.
std::string refusal(const ClothMesh& cloth, const DrawnMesh& drawn,
                    const EmbeddingOptions& options = {}) {
  try {
    const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, drawn, options);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(ClothEmbedding, RefusesWhatCannotBeLed) {
  const ClothMesh cloth = coarse_cloth();
  const DrawnMesh sheet = fine_sheet(3, 0.4, 0.01);
  EXPECT_EQ(refusal(cloth, sheet), "");
  DrawnMesh wrong = sheet;
  wrong.triangles.resize(3, 0);
  EXPECT_EQ(refusal(cloth, wrong), "drawn mesh: no triangle, expected at least one");
  wrong = sheet;
  wrong.positions(1, 4) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(cloth, wrong), "drawn mesh: the position of vertex 4 is not finite");
  wrong = sheet;
  wrong.triangles(2, 1) = 9;
  EXPECT_EQ(refusal(cloth, wrong), "drawn mesh: triangle 1 names vertex 9, expected 0 to 8");
  wrong = sheet;
  wrong.normals = Matrix3X<double>::Zero(3, 9);
  EXPECT_EQ(
      refusal(cloth, wrong),
      "drawn mesh: the normal of vertex 0 has a length of 0.000000 [-], expected > 0 and finite");
  wrong.normals = Matrix3X<double>::Ones(3, 4);
  EXPECT_EQ(refusal(cloth, wrong),
            "drawn mesh: 4 normals, expected 9, one of each vertex, or none");
  wrong = sheet;
  wrong.positions(1, 5) = 0.2;
  EXPECT_EQ(refusal(cloth, wrong, {.max_distance = 0.05}),
            "embedding: vertex 5 of the drawn mesh is 0.200000 m from the cloth, expected at most "
            "0.050000 m (1 vertices are farther)");
  EXPECT_EQ(refusal(cloth, sheet, {.max_distance = -1.0}),
            "embedding: max_distance = -1.000000 [m], expected > 0 and finite, or none");
  ClothMesh rope = cloth;
  rope.triangles.resize(3, 0);
  EXPECT_EQ(refusal(rope, sheet), "embedding: the cloth has no triangle, expected a surface");
  ClothMesh thin = cloth;
  thin.rest_positions.col(1) = thin.rest_positions.col(0);
  EXPECT_EQ(refusal(thin, sheet), "embedding: triangle 0 of the cloth has no area, expected one");
}

TEST(ClothEmbedding, AWrongNumberOfNodesIsRefused) {
  const ClothMesh cloth = coarse_cloth();
  const ClothEmbedding embedding(cloth.rest_positions, cloth.triangles, fine_sheet(3, 0.4, 0.0));
  ClothPose pose = embedding.make_pose();
  EXPECT_THROW(embedding.set_pose(cloth.rest_positions.leftCols(7), pose), InvalidArgument);
}

TEST(ClothEmbedding, ADrawnMeshMayBranch) {
  DrawnMesh book = fine_sheet(2, 0.3, 0.0);
  book.positions.conservativeResize(3, 5);
  book.positions.col(4) = Vector3<double>(0, 0.1, 0);
  book.triangles.conservativeResize(3, 4);
  book.triangles.col(2) << book.triangles(0, 0), book.triangles(1, 0), 4;
  book.triangles.col(3) << book.triangles(1, 0), book.triangles(0, 0), 4;
  EXPECT_EQ(refusal(coarse_cloth(), book), "");
}

}  // namespace
}  // namespace weft
