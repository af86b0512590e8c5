#include <weft/playback/rendering/meshes/mark_mesh.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace weft::scenes {
namespace {

constexpr double kMarkRadius = 0.1;  // [m]

Mark mark_of(MarkKind kind) {
  Mark mark{kind, "force", {}, Matrix3X<float>(3, 1), Matrix3X<float>(3, 0)};
  mark.from << 1.0f, 2.0f, 3.0f;
  if (kind != MarkKind::kPoints) mark.to = mark.from + Eigen::Vector3f(2.0f, 0.0f, 0.0f);
  return mark;
}

Eigen::AlignedBox3f box_of(const SurfaceMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const SurfaceVertex& vertex : mesh.vertices) box.extend(vertex.position);
  return box;
}

/// The triangles close in this volume; it is negative where they are seen from behind. [m^3]
double closed_volume(const SurfaceMesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]].position; };
    sum += static_cast<double>(corner(0).dot(corner(1).cross(corner(2)))) / 6.0;
  }
  return sum;
}

TEST(MarkMeshes, APointIsABallAroundIt) {
  const SurfaceMesh mesh = mark_surface(mark_of(MarkKind::kPoints), kMarkRadius, {});
  EXPECT_NEAR(box_of(mesh).center().x(), 1.0, 1e-6);
  EXPECT_NEAR(box_of(mesh).sizes().y(), 2 * kMarkRadius, 1e-6);
  EXPECT_GT(closed_volume(mesh), 0.7 * 4.19 * kMarkRadius * kMarkRadius * kMarkRadius)
      << "seen from inside";
}

TEST(MarkMeshes, LinesAndArrowsGoFromEndToEnd) {
  for (const MarkKind kind : {MarkKind::kLines, MarkKind::kArrows}) {
    const Eigen::AlignedBox3f box = box_of(mark_surface(mark_of(kind), kMarkRadius, {}));
    EXPECT_NEAR(box.min().x(), 1.0, 1e-6);
    EXPECT_NEAR(box.max().x(), 3.0, 1e-6);
    EXPECT_LT(box.sizes().y(), 2.5 * kMarkRadius);
  }
  const auto widest_at = [](MarkKind kind) {
    const SurfaceMesh mesh = mark_surface(mark_of(kind), kMarkRadius, {});
    float widest = 0.0f;
    float place = 0.0f;
    for (const SurfaceVertex& vertex : mesh.vertices) {
      const float distance = (vertex.position - Eigen::Vector3f(vertex.position.x(), 2, 3)).norm();
      if (distance > widest) widest = distance, place = vertex.position.x();
    }
    return place;
  };
  EXPECT_NEAR(widest_at(MarkKind::kArrows), 3.0 - 3.5 * kMarkRadius, 1e-5)
      << "the tip is elsewhere";
}

TEST(MarkMeshes, NormalsLookOutwards) {
  for (const MarkKind kind : {MarkKind::kPoints, MarkKind::kLines, MarkKind::kArrows}) {
    const SurfaceMesh mesh = mark_surface(mark_of(kind), kMarkRadius, {});
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const SurfaceVertex& a = mesh.vertices[mesh.indices[i]];
      const SurfaceVertex& b = mesh.vertices[mesh.indices[i + 1]];
      const SurfaceVertex& c = mesh.vertices[mesh.indices[i + 2]];
      const Eigen::Vector3f face = (b.position - a.position).cross(c.position - a.position);
      if (face.norm() < 1e-9f) continue;  // at a pole or a tip
      EXPECT_GT(face.dot(a.normal + b.normal + c.normal), 0.0f) << static_cast<int>(kind);
    }
  }
}

TEST(MarkMeshes, WhatCannotBeDrawnIsLeftOut) {
  Mark mark = mark_of(MarkKind::kArrows);
  mark.to = mark.from;
  EXPECT_TRUE(mark_surface(mark, kMarkRadius, {}).vertices.empty()) << "a force of zero";
  mark.to(1, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(mark_surface(mark, kMarkRadius, {}).vertices.empty());
  mark = mark_of(MarkKind::kPoints);
  mark.from(0, 0) = 2e6f;
  EXPECT_TRUE(mark_surface(mark, kMarkRadius, {}).vertices.empty());
  EXPECT_FALSE(mark_surface(mark, kMarkRadius, {.largest = 1e7}).vertices.empty());
}

}  // namespace
}  // namespace weft::scenes
