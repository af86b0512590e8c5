#include <weft/mesh/embedding/drawn_mesh.hpp>

#include <array>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>

namespace weft {
namespace {

void require_drawn(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("drawn mesh: " + message);
}

void check_directions(const Matrix3X<double>& directions, Eigen::Index num_vertices,
                      const std::string& name) {
  if (directions.cols() == 0) return;
  require_drawn(directions.cols() == num_vertices,
                std::to_string(directions.cols()) + " " + name + "s, expected " +
                    std::to_string(num_vertices) + ", one of each vertex, or none");
  for (Eigen::Index v = 0; v < num_vertices; ++v) {
    const double length = directions.col(v).norm();
    require_drawn(length > 0 && std::isfinite(length),
                  "the " + name + " of vertex " + std::to_string(v) + " has a length of " +
                      std::to_string(length) + " [-], expected > 0 and finite");
  }
}

}  // namespace

void check_drawn_mesh(const DrawnMesh& mesh) {
  require_drawn(mesh.triangles.cols() > 0, "no triangle, expected at least one");
  const Eigen::Index num_vertices = mesh.positions.cols();
  for (Eigen::Index v = 0; v < num_vertices; ++v) {
    require_drawn(mesh.positions.col(v).allFinite(),
                  "the position of vertex " + std::to_string(v) + " is not finite");
  }
  check_directions(mesh.normals, num_vertices, "normal");
  check_directions(mesh.tangents, num_vertices, "tangent");
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (const int vertex : mesh.triangles.col(t)) {
      require_drawn(vertex >= 0 && vertex < num_vertices,
                    "triangle " + std::to_string(t) + " names vertex " + std::to_string(vertex) +
                        ", expected 0 to " + std::to_string(num_vertices - 1));
    }
  }
}

std::vector<int> first_at_place(ConstMatrix3XRef<double> positions) {
  std::map<std::array<double, 3>, int> known;
  std::vector<int> first;
  for (Eigen::Index v = 0; v < positions.cols(); ++v) {
    // + 0.0: -0 and 0 are one place.
    const std::array<double, 3> place = {positions(0, v) + 0.0, positions(1, v) + 0.0,
                                         positions(2, v) + 0.0};
    first.push_back(known.try_emplace(place, static_cast<int>(v)).first->second);
  }
  return first;
}

Matrix3X<double> surface_normals(ConstMatrix3XRef<double> positions, const Triangles& triangles) {
  const std::vector<int> first = first_at_place(positions);
  Matrix3X<double> normals = Matrix3X<double>::Zero(3, positions.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Vector3<double> a = positions.col(triangles(0, t));
    const Vector3<double> b = positions.col(triangles(1, t));
    const Vector3<double> c = positions.col(triangles(2, t));
    const Vector3<double> normal = (b - a).cross(c - a);
    for (const int vertex : triangles.col(t)) {
      normals.col(first[static_cast<std::size_t>(vertex)]) += normal;
    }
  }
  for (Eigen::Index v = 0; v < normals.cols(); ++v) {
    const int shared = first[static_cast<std::size_t>(v)];
    // The first one comes before those that share its place.
    normals.col(v) = shared == v ? normals.col(v).normalized() : normals.col(shared);
  }
  return normals;
}

}  // namespace weft
