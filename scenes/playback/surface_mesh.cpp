#include <weft/scenes/playback/surface_mesh.hpp>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace weft::scenes {
namespace {

/// Adds a grid of (columns + 1) x (rows + 1) vertices; make(u, v) with u, v from 0 to 1, and u x v
/// is the outside.
template <class Make>
void append_patch(SurfaceMesh& mesh, int columns, int rows, Make make) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto stride = static_cast<std::uint32_t>(columns + 1);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      mesh.vertices.push_back(
          make(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
    }
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
      const std::uint32_t a = first + j * stride + i;
      mesh.indices.insert(mesh.indices.end(),
                          {a, a + 1, a + stride, a + 1, a + stride + 1, a + stride});
    }
  }
}

SurfaceVertex body_vertex(const Vector3<double>& position, const Vector3<double>& normal) {
  SurfaceVertex vertex;
  vertex.position = position.cast<float>();
  vertex.normal = normal.cast<float>();
  vertex.extra = vertex.position;
  return vertex;
}

}  // namespace

SurfaceMesh cloth_surface(const Triangles& triangles, ConstMatrix3XRef<double> positions,
                          const DrawLimits& limits) {
  const auto num_nodes = static_cast<std::size_t>(positions.cols());
  SurfaceMesh mesh;
  mesh.vertices.resize(num_nodes);
  std::vector<bool> is_drawable(num_nodes);
  for (std::size_t i = 0; i < num_nodes; ++i) {
    const Vector3<double> x = positions.col(static_cast<Eigen::Index>(i)) - limits.origin;
    is_drawable[i] = x.allFinite() && x.cwiseAbs().maxCoeff() <= limits.largest;
    if (is_drawable[i]) mesh.vertices[i].position = x.cast<float>();
    mesh.vertices[i].normal.setZero();
  }
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const auto a = static_cast<std::size_t>(triangles(0, t));
    const auto b = static_cast<std::size_t>(triangles(1, t));
    const auto c = static_cast<std::size_t>(triangles(2, t));
    if (!is_drawable[a] || !is_drawable[b] || !is_drawable[c]) continue;
    for (const std::size_t node : {a, b, c}) {
      mesh.indices.push_back(static_cast<std::uint32_t>(node));
    }
    // Not normalised: a large triangle has more to say about the normal than a sliver.
    const Eigen::Vector3f normal =
        (mesh.vertices[b].position - mesh.vertices[a].position)
            .cross(mesh.vertices[c].position - mesh.vertices[a].position);
    for (const std::size_t node : {a, b, c}) mesh.vertices[node].normal += normal;
  }
  for (SurfaceVertex& vertex : mesh.vertices) {
    const float length = vertex.normal.norm();
    if (length > 0.0f && std::isfinite(length)) {
      vertex.normal /= length;
    } else {
      vertex.normal = Eigen::Vector3f::UnitY();
    }
  }
  return mesh;
}

SurfaceMesh with_barycentrics(const SurfaceMesh& mesh) {
  SurfaceMesh split;
  split.vertices.reserve(mesh.indices.size());
  split.indices.reserve(mesh.indices.size());
  for (std::size_t k = 0; k < mesh.indices.size(); ++k) {
    SurfaceVertex vertex = mesh.vertices[mesh.indices[k]];
    vertex.extra = Eigen::Vector3f::Unit(static_cast<Eigen::Index>(k % 3));
    split.vertices.push_back(vertex);
    split.indices.push_back(static_cast<std::uint32_t>(k));
  }
  return split;
}

SurfaceMesh sphere_surface(double radius) {
  constexpr int kColumns = 96;
  constexpr int kRows = 48;
  SurfaceMesh mesh;
  append_patch(mesh, kColumns, kRows, [&](double u, double v) {
    const double longitude = -2.0 * std::numbers::pi * u;
    const double latitude = std::numbers::pi * (v - 0.5);
    const Vector3<double> normal(std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                                 std::cos(latitude) * std::sin(longitude));
    return body_vertex(radius * normal, normal);
  });
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
        return body_vertex(corner.cwiseProduct(half_extents), normal);
      });
    }
  }
  return mesh;
}

SurfaceMesh ground_surface(double extent) {
  constexpr int kDivisions = 72;
  SurfaceMesh mesh;
  const auto spread = [&](double part) {
    const double t = 2.0 * part - 1.0;
    return extent * t * (0.15 + 0.85 * t * t);
  };
  append_patch(mesh, kDivisions, kDivisions, [&](double u, double v) {
    return body_vertex({spread(u), 0.0, -spread(v)}, Vector3<double>::UnitY());
  });
  return mesh;
}

}  // namespace weft::scenes
