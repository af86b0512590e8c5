#include <weft/playback/rendering/meshes/shape_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace weft::scenes {
namespace {

constexpr int kColumns = 96;  // around an axis

/// A point of a profile that is turned around the y axis.
struct ProfilePoint {
  double radius;
  double height;
  double normal_out;  ///< of the outward normal
  double normal_up;
};

SurfaceMesh revolved(const std::vector<ProfilePoint>& profile) {
  SurfaceMesh mesh;
  const int rows = static_cast<int>(profile.size()) - 1;
  append_patch(mesh, kColumns, rows, [&](double u, double v) {
    const ProfilePoint& point = profile[static_cast<std::size_t>(std::lround(v * rows))];
    const double angle = -2.0 * std::numbers::pi * u;
    const Vector3<double> out(std::cos(angle), 0.0, std::sin(angle));
    const Vector3<double> up = Vector3<double>::UnitY();
    return body_vertex(point.radius * out + point.height * up,
                       point.normal_out * out + point.normal_up * up, {u, v});
  });
  return mesh;
}

/// A flat end of a body: side = 1 looks up, -1 down.
void append_disk(SurfaceMesh& mesh, double radius, double height, double side) {
  constexpr int kRings = 8;
  append_patch(mesh, kColumns, kRings, [&](double u, double v) {
    const double angle = side * -2.0 * std::numbers::pi * u;
    const double distance = (1.0 - v) * radius;
    const Vector3<double> place(distance * std::cos(angle), height, distance * std::sin(angle));
    return body_vertex(place, side * Vector3<double>::UnitY(),
                       {0.5 + 0.5 * place.x() / radius, 0.5 - 0.5 * place.z() / radius});
  });
}

}  // namespace

SurfaceMesh sphere_surface(double radius) {
  return capsule_surface(radius, 0.0);
}

SurfaceMesh capsule_surface(double radius, double half_height) {
  constexpr int kRows = 48;  // half of them for each end; the straight part lies between
  constexpr int kStraight = 16;
  std::vector<ProfilePoint> profile;
  const auto add = [&](double latitude, double height) {
    profile.push_back({radius * std::cos(latitude), height + radius * std::sin(latitude),
                       std::cos(latitude), std::sin(latitude)});
  };
  for (int i = 0; i <= kRows / 2; ++i)
    add(std::numbers::pi * (static_cast<double>(i) / kRows - 0.5), -half_height);
  if (half_height > 0.0) {
    for (int i = 1; i < kStraight; ++i) add(0.0, half_height * (2.0 * i / kStraight - 1.0));
    add(0.0, half_height);
  }
  for (int i = kRows / 2 + 1; i <= kRows; ++i) {
    add(std::numbers::pi * (static_cast<double>(i) / kRows - 0.5), half_height);
  }
  return revolved(profile);
}

SurfaceMesh cylinder_surface(double radius, double half_height) {
  constexpr int kRows = 16;
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= kRows; ++i) {
    profile.push_back({radius, half_height * (2.0 * i / kRows - 1.0), 1.0, 0.0});
  }
  SurfaceMesh mesh = revolved(profile);
  append_disk(mesh, radius, half_height, 1.0);
  append_disk(mesh, radius, -half_height, -1.0);
  return mesh;
}

SurfaceMesh cone_surface(double radius, double half_height) {
  constexpr int kRows = 24;
  const double slant = std::hypot(radius, 2.0 * half_height);
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= kRows; ++i) {
    const double part = static_cast<double>(i) / kRows;
    profile.push_back({radius * (1.0 - part), half_height * (2.0 * part - 1.0),
                       2.0 * half_height / slant, radius / slant});
  }
  SurfaceMesh mesh = revolved(profile);
  append_disk(mesh, radius, -half_height, -1.0);
  return mesh;
}

SurfaceMesh box_surface(const Vector3<double>& half_extents) {
  constexpr int kDivisions = 16;
  SurfaceMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vector3<double> normal = side * Vector3<double>::Unit(axis);
      const Vector3<double> across = Vector3<double>::Unit((axis + 1) % 3);
      const Vector3<double> along = normal.cross(across);
      append_patch(mesh, kDivisions, kDivisions, [&](double u, double v) {
        const Vector3<double> corner = normal + (2.0 * u - 1.0) * across + (2.0 * v - 1.0) * along;
        return body_vertex(corner.cwiseProduct(half_extents), normal, {u, v});
      });
    }
  }
  return mesh;
}

SurfaceMesh triangle_surface(ConstMatrix3XRef<double> positions, const Triangles& triangles,
                             double crease_angle) {
  const double largest_cosine = std::cos(crease_angle);
  std::vector<std::vector<Eigen::Index>> around(static_cast<std::size_t>(positions.cols()));
  Matrix3X<double> areas(3, triangles.cols());  // normals, as long as the area is large
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Vector3<double> a = positions.col(triangles(0, t));
    const Vector3<double> b = positions.col(triangles(1, t));
    const Vector3<double> c = positions.col(triangles(2, t));
    areas.col(t) = (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k) around[static_cast<std::size_t>(triangles(k, t))].push_back(t);
  }
  const Vector3<double> low = positions.rowwise().minCoeff();
  const Vector3<double> size =
      (positions.rowwise().maxCoeff() - low).cwiseMax(1e-12);  // flat bodies: no division by zero
  SurfaceMesh mesh;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Vector3<double> own = areas.col(t).normalized();
    if (!own.allFinite() || own.squaredNorm() == 0.0) continue;
    for (int k = 0; k < 3; ++k) {
      const Vector3<double> x = positions.col(triangles(k, t));
      Vector3<double> normal = Vector3<double>::Zero();
      for (const Eigen::Index other : around[static_cast<std::size_t>(triangles(k, t))]) {
        if (areas.col(other).normalized().dot(own) >= largest_cosine) normal += areas.col(other);
      }
      const Vector3<double> part = (x - low).cwiseQuotient(size);
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(body_vertex(x, normal.normalized(), {part.x(), 1.0 - part.z()}));
    }
  }
  return mesh;
}

void append_surface(SurfaceMesh& mesh, const SurfaceMesh& part, const Eigen::Isometry3d& pose) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Isometry3f place = pose.cast<float>();
  for (SurfaceVertex vertex : part.vertices) {
    vertex.position = place * vertex.position;
    vertex.normal = place.linear() * vertex.normal;
    vertex.extra = vertex.position;
    mesh.vertices.push_back(vertex);
  }
  for (const std::uint32_t index : part.indices) mesh.indices.push_back(first + index);
}

}  // namespace weft::scenes
