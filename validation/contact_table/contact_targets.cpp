// Tested by tests/validation/contact_table/contact_table_test.cpp.

#include <cmath>
#include <numbers>
#include <utility>

#include <weft/validation/contact_table/contact_table.hpp>

namespace weft::validation {
namespace {

using Mover = ContactTarget::Mover;

constexpr double kRadius = 0.3;  // [m] of most of the solids

/// height [m]: of the shape's highest point over its origin.
ContactTarget fixed(std::string name, scenes::Shape shape, double height, double radius = kRadius) {
  ContactTarget target;
  target.name = std::move(name);
  target.collider.name = "target";
  target.collider.shape = std::move(shape);
  target.collider.position = {0, -height, 0};
  target.radius = radius;
  return target;
}

ContactTarget moving(std::string name, scenes::Shape shape, Mover mover) {
  ContactTarget target = fixed(std::move(name), std::move(shape), kRadius);
  target.mover = mover;
  return target;
}

/// The corners of an icosahedron.
scenes::ConvexHullShape icosahedron() {
  const double golden = std::numbers::phi;
  scenes::ConvexHullShape hull{Matrix3X<double>(3, 12)};
  int i = 0;
  for (const double one : {-1.0, 1.0}) {
    for (const double other : {-golden, golden}) {
      hull.points.col(i++) = Vector3<double>(0, one, other);
      hull.points.col(i++) = Vector3<double>(one, other, 0);
      hull.points.col(i++) = Vector3<double>(other, 0, one);
    }
  }
  // The ball inside it has 0.7558 of the edge as radius; the edge is 2 here.
  hull.points *= kRadius / (2.0 * 0.7557613);
  return hull;
}

/// A ring around the y axis; its tube has 0.15 m, its middle line 0.35 m as radius.
scenes::MeshShape torus(int around, int along_tube) {
  constexpr double kTube = 0.15;
  constexpr double kMiddle = 0.35;
  scenes::MeshShape mesh{Matrix3X<double>(3, around * along_tube),
                         Triangles(3, 2 * around * along_tube)};
  Eigen::Index t = 0;
  for (int i = 0; i < around; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / around;
    for (int j = 0; j < along_tube; ++j) {
      const double tilt = 2.0 * std::numbers::pi * j / along_tube;
      const double out = kMiddle + kTube * std::cos(tilt);
      mesh.points.col(i * along_tube + j) =
          Vector3<double>(out * std::cos(turn), kTube * std::sin(tilt), -out * std::sin(turn));
      const int next_i = (i + 1) % around * along_tube;
      const int next_j = (j + 1) % along_tube;
      const int a = i * along_tube + j;
      mesh.triangles.col(t++) = Vector3<int>(a, next_i + j, next_i + next_j);
      mesh.triangles.col(t++) = Vector3<int>(a, next_i + next_j, i * along_tube + next_j);
    }
  }
  return mesh;
}

scenes::CompoundShape dumbbell() {
  const auto turned =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3<double>::UnitZ()));
  return {{{scenes::SphereShape{0.25}, {-0.35, 0, 0}},
           {scenes::SphereShape{0.25}, {0.35, 0, 0}},
           {scenes::CylinderShape{0.15, 0.7}, {0, 0, 0}, turned}}};
}

/// Hills of 0.1 m.
scenes::HeightFieldShape hills() {
  constexpr int kSamples = 9;
  scenes::HeightFieldShape field{{1.6, 1.6}, Eigen::MatrixXd(kSamples, kSamples)};
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const double x = std::numbers::pi * (i - kSamples / 2) / 3.0;
      const double z = std::numbers::pi * (j - kSamples / 2) / 3.0;
      field.heights(j, i) = 0.05 * (std::cos(x) + std::cos(z));
    }
  }
  return field;
}

}  // namespace

std::vector<ContactTarget> contact_targets() {
  std::vector<ContactTarget> targets = {
      fixed("plane", scenes::PlaneShape{}, 0.0),
      fixed("sphere", scenes::SphereShape{kRadius}, kRadius),
      fixed("box", scenes::BoxShape{{kRadius, kRadius, kRadius}}, kRadius),
      fixed("capsule", scenes::CapsuleShape{kRadius, 0.3}, kRadius + 0.15),
      fixed("cylinder", scenes::CylinderShape{kRadius, 2 * kRadius}, kRadius),
      fixed("cone", scenes::ConeShape{0.5, 0.8}, 0.4, 0.24),
      fixed("convex hull", icosahedron(), kRadius * 1.26),
      fixed("mesh, prisms", torus(16, 8), 0.15, 0.15),
      fixed("mesh, Bullet's triangles", torus(16, 8), 0.15, 0.15),
      fixed("compound", dumbbell(), 0.25, 0.25),
      fixed("height field, prisms", hills(), 0.1),
      fixed("height field, Bullet's triangles", hills(), 0.1),
      moving("sphere, kinematic", scenes::SphereShape{kRadius}, Mover::kKinematic),
      moving("box, kinematic", scenes::BoxShape{{kRadius, kRadius, kRadius}}, Mover::kKinematic),
      moving("sphere, dynamic 1 kg", scenes::SphereShape{kRadius}, Mover::kDynamic),
      moving("box, dynamic 1 kg", scenes::BoxShape{{kRadius, kRadius, kRadius}}, Mover::kDynamic),
  };
  for (ContactTarget& target : targets) {
    if (target.name.ends_with("triangles")) target.concave = scenes::ConcaveContact::kTriangles;
  }
  return targets;
}

}  // namespace weft::validation
