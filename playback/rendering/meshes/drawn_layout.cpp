#include <weft/playback/rendering/meshes/drawn_layout.hpp>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include <weft/playback/rendering/meshes/cloth_layout.hpp>

namespace weft::scenes {
namespace {

/// Below it, the side of a button or the rim of a hem is round; above it, it is an edge.
constexpr double kCreaseAngle = 50.0 * std::numbers::pi / 180.0;

/// Twice the area times the normal of each triangle, 3 x t.
Matrix3X<double> area_normals(const Surface& surface) {
  Matrix3X<double> normals(3, surface.triangles.cols());
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const Matrix3<double> x = surface.positions(Eigen::all, surface.triangles.col(t));
    normals.col(t) =
        Vector3<double>(x.col(1) - x.col(0)).cross(Vector3<double>(x.col(2) - x.col(0)));
  }
  return normals;
}

std::vector<std::vector<int>> triangles_around(const Surface& surface) {
  std::vector<std::vector<int>> around(static_cast<std::size_t>(surface.positions.cols()));
  for (int t = 0; t < static_cast<int>(surface.triangles.cols()); ++t) {
    for (const int node : surface.triangles.col(t)) {
      around[static_cast<std::size_t>(node)].push_back(t);
    }
  }
  return around;
}

/// The normal of a corner: over the triangles around its node that meet its own without a crease. The same sum, in the same order,
/// for all corners of a smooth neighborhood, so that they become one vertex.
Vector3<double> corner_normal(const Matrix3X<double>& normals, const std::vector<int>& around,
                              int triangle) {
  const Vector3<double> own = normals.col(triangle).normalized();
  Vector3<double> sum = Vector3<double>::Zero();
  for (const int t : around) {
    if (t == triangle || own.dot(normals.col(t).normalized()) > std::cos(kCreaseAngle)) {
      sum += normals.col(t);
    }
  }
  const double length = sum.norm();
  return length > 0 ? Vector3<double>(sum / length) : Vector3<double>(0, 1, 0);
}

}  // namespace

DrawnLayout make_drawn_layout(const Surface& surface) {
  ClothMesh welded;
  welded.rest_positions = surface.positions;
  welded.triangles = surface.triangles;
  welded.texture_coordinates = surface.texture_coordinates;
  welded.corner_texture_coordinates = surface.corner_texture_coordinates;
  const Matrix2X<double> places = corner_coordinates(welded);
  DrawnLayout layout;
  layout.has_coordinates = places.cols() > 0;
  layout.is_closed = make_layout(welded).is_closed;
  layout.mesh.triangles.resize(3, surface.triangles.cols());
  const Vector3<double> center = surface.positions.rowwise().mean();
  const Matrix3X<double> normals = area_normals(surface);
  const std::vector<std::vector<int>> around = triangles_around(surface);
  std::map<std::array<double, 6>, int> known;
  std::vector<Vector3<double>> positions;
  std::vector<Vector3<double>> directions;
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int node = surface.triangles(k, t);
      const Vector3<double> normal =
          corner_normal(normals, around[static_cast<std::size_t>(node)], static_cast<int>(t));
      Eigen::Vector2d place(0, 0);
      if (layout.has_coordinates) place = places.col(3 * t + k);
      const std::array<double, 6> key = {
          static_cast<double>(node), place.x(), place.y(), normal.x(), normal.y(), normal.z()};
      const auto [entry, is_new] = known.try_emplace(key, static_cast<int>(positions.size()));
      layout.mesh.triangles(k, t) = entry->second;
      if (!is_new) continue;
      positions.emplace_back(surface.positions.col(node));
      directions.push_back(normal);
      layout.coordinates.push_back(place.cast<float>());
      layout.rest_places.emplace_back((positions.back() - center).cast<float>());
    }
  }
  const auto columns = [](const std::vector<Vector3<double>>& vectors) {
    return Matrix3X<double>(
        Eigen::Map<const Matrix3X<double>>(vectors[0].data(), 3, std::ssize(vectors)));
  };
  layout.mesh.positions = columns(positions);
  layout.mesh.normals = columns(directions);
  return layout;
}

}  // namespace weft::scenes
