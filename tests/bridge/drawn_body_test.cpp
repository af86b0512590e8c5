#include <weft/bridge/drawn_body.hpp>

#include <algorithm>
#include <memory>
#include <vector>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/tearing.hpp>
#include <weft/core/error.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::bridge {
namespace {

ClothMesh coarse() {
  return make_cloth_grid({.nodes = {9, 9}, .size = {0.8, 0.8}});
}

DrawnMesh fine(double height) {
  const ClothMesh grid =
      make_cloth_grid({.nodes = {40, 40}, .size = {0.78, 0.78}, .center = {0, height, 0}});
  return {.positions = grid.rest_positions, .triangles = grid.triangles};
}

btTransform turned() {
  return btTransform(btQuaternion(btVector3(btScalar(0.6), btScalar(0.8), 0), btScalar(0.9)),
                     btVector3(1, btScalar(-0.5), btScalar(0.25)));
}

/// In single precision positions of about 1 m are rounded to 6e-8 m, and gradients over 10 cm to 1e-6.
constexpr double kRounding = 1e-6;

TEST(DrawnBody, FollowsABodyThatMovesRigidly) {
  btSoftBodyWorldInfo info;
  const auto body = make_cloth_body(info, coarse(), {});
  const DrawnMesh mesh = fine(0.02);
  DrawnBody drawn(coarse(), mesh);
  body->transform(turned());
  EXPECT_FALSE(drawn.update(*body));
  for (int v = 0; v < drawn.embedding().num_vertices(); ++v) {
    const Vector3<double> rest = mesh.positions.col(v);
    const btVector3 place =
        turned() * btVector3(btScalar(rest.x()), btScalar(rest.y()), btScalar(rest.z()));
    const btVector3 normal = turned().getBasis() * btVector3(0, 1, 0);
    const DrawnVertex vertex = drawn.vertex(v);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(vertex.position[i], static_cast<double>(place[i]), kRounding);
      EXPECT_NEAR(vertex.normal[i], static_cast<double>(normal[i]), 5 * kRounding);
    }
  }
}

// What Bullet's helpers make, with faces that are not wound alike, is bound where it lies.
TEST(DrawnBody, LeadsFromABodyOfBulletsHelpers) {
  btSoftBodyWorldInfo info;
  const std::unique_ptr<btSoftBody> body(btSoftBodyHelpers::CreatePatch(
      info, btVector3(btScalar(-0.4), 0, btScalar(-0.4)),
      btVector3(btScalar(0.4), 0, btScalar(-0.4)), btVector3(btScalar(-0.4), 0, btScalar(0.4)),
      btVector3(btScalar(0.4), 0, btScalar(0.4)), 9, 9, 0, true));
  const DrawnMesh mesh = fine(-0.01);
  DrawnBody drawn(*body, mesh);
  body->translate(btVector3(0, 2, 0));
  drawn.update(*body);
  for (int v = 0; v < drawn.embedding().num_vertices(); ++v) {
    EXPECT_NEAR(drawn.vertex(v).position.y(), 1.99, kRounding);
  }
}

TEST(DrawnBody, WritesIntoArraysAndStructures) {
  btSoftBodyWorldInfo info;
  const auto body = make_cloth_body(info, coarse(), {});
  DrawnMesh mesh = fine(0.01);
  mesh.tangents = Matrix3X<double>::Zero(3, mesh.positions.cols());
  mesh.tangents.row(0).setOnes();
  DrawnBody drawn(coarse(), mesh);
  drawn.update(*body);
  struct Vertex {
    float position[3];
    float normal[3];
    float tangent[3];
    float color;
  };
  const auto num = static_cast<std::size_t>(drawn.embedding().num_vertices());
  std::vector<Vertex> vertices(num, {{7, 7, 7}, {7, 7, 7}, {7, 7, 7}, 7});
  const VertexBuffers buffers{vertices[0].position, vertices[0].normal, vertices[0].tangent,
                              sizeof(Vertex)};
  drawn.write(buffers, 0, 100);
  EXPECT_EQ(vertices[100].position[0], 7);
  drawn.write(buffers);
  std::vector<float> plain(3 * num);
  drawn.write({.positions = plain.data()});
  for (std::size_t v = 0; v < num; ++v) {
    const DrawnVertex expected = drawn.vertex(static_cast<int>(v));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      EXPECT_EQ(vertices[v].position[i], static_cast<float>(expected.position[axis]));
      EXPECT_EQ(vertices[v].normal[i], static_cast<float>(expected.normal[axis]));
      EXPECT_EQ(vertices[v].tangent[i], static_cast<float>(expected.tangent[axis]));
      EXPECT_EQ(plain[3 * v + i], vertices[v].position[i]);
    }
    EXPECT_EQ(vertices[v].color, 7);
  }
  EXPECT_NEAR(vertices[5].tangent[0], 1, kRounding);
  EXPECT_THROW(drawn.write({.positions = plain.data(), .stride = 8}), InvalidArgument);
  EXPECT_THROW(drawn.write({.positions = plain.data(), .stride = 13}), InvalidArgument);
}

TEST(DrawnBody, TearsWithTheBody) {
  btSoftBodyWorldInfo info;
  const ClothMesh mesh = coarse();
  const auto body = make_cloth_body(info, mesh, {});
  DrawnBody drawn(mesh, fine(0.01));
  const int num_before = drawn.embedding().num_vertices();
  Edges cut(2, 8);
  for (int j = 0; j < 8; ++j) cut.col(j) << 9 * j + 4, 9 * (j + 1) + 4;
  const Tear tear = cut_along(mesh, cut);
  apply_tear(tear, {}, *body);
  // The side of node 8 goes away.
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int node = tear.mesh.triangles(corner, t);
      const bool is_right = mesh.rest_positions(0, mesh.triangles.col(t)).mean() > 0;
      const double shift = is_right ? 1.0 : 0.0;
      body->m_nodes[node].m_x.setX(btScalar(tear.mesh.rest_positions(0, node) + shift));
    }
  }
  EXPECT_TRUE(drawn.update(*body));
  EXPECT_FALSE(drawn.update(*body));
  EXPECT_GT(drawn.embedding().num_vertices(), num_before);
  const Triangles& triangles = drawn.embedding().drawn_triangles();
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    double low = 10;
    double high = -10;
    for (const int v : triangles.col(t)) {
      low = std::min(low, drawn.vertex(v).position.x());
      high = std::max(high, drawn.vertex(v).position.x());
    }
    EXPECT_LT(high - low, 0.03) << t;
  }
}

TEST(DrawnBody, RefusesAnotherBody) {
  btSoftBodyWorldInfo info;
  DrawnBody drawn(coarse(), fine(0.01));
  const auto small = make_cloth_body(info, make_cloth_grid({.nodes = {3, 3}}), {});
  EXPECT_THROW(drawn.update(*small), InvalidArgument);
  const auto large = make_cloth_body(info, make_cloth_grid({.nodes = {12, 12}}), {});
  EXPECT_THROW(drawn.update(*large), InvalidArgument);
}

}  // namespace
}  // namespace weft::bridge
