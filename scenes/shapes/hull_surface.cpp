// Tested by tests/scenes/format/scene_file_test.cpp, tests/engines/bullet/bullet_shapes_test.cpp.

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <weft/core/error.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::scenes {
namespace {

/// Points this close to a face, as a share of the hull's size, count as on it [-].
constexpr double kFlatness = 1e-9;

struct Face {
  Vector3<double> normal;   // outward, unit
  std::vector<int> points;  // in the plane of the face, sorted
};

/// The plane through three of the points, if all others lie on one side of it.
bool find_face(const Matrix3X<double>& x, const std::array<int, 3>& corner, double size,
               Face& face) {
  const Vector3<double> a = x.col(corner[0]);
  Vector3<double> normal = Vector3<double>(x.col(corner[1]) - a).cross(x.col(corner[2]) - a);
  const double length = normal.norm();
  if (length <= kFlatness * size * size) return false;
  normal /= length;
  face.points.clear();
  int side = 0;
  for (int i = 0; i < x.cols(); ++i) {
    const double height = normal.dot(x.col(i) - a);
    if (std::abs(height) <= kFlatness * size) {
      face.points.push_back(i);
    } else if (side == 0) {
      side = height > 0 ? 1 : -1;
    } else if ((height > 0) != (side > 0)) {
      return false;
    }
  }
  face.normal = side > 0 ? Vector3<double>(-normal) : normal;
  return side != 0;
}

/// The face's corners, counter-clockwise seen from outside: points inside it and on its edges are
/// left out.
std::vector<int> outline(const Matrix3X<double>& x, const Face& face, double size) {
  const Vector3<double> u = face.normal.unitOrthogonal();
  const Vector3<double> v = face.normal.cross(u);
  std::vector<int> order = face.points;
  const auto place = [&](int i) { return std::pair(u.dot(x.col(i)), v.dot(x.col(i))); };
  std::sort(order.begin(), order.end(), [&](int i, int j) { return place(i) < place(j); });
  const auto turns_left = [&](int i, int j, int k) {
    const auto [xi, yi] = place(i);
    const auto [xj, yj] = place(j);
    const auto [xk, yk] = place(k);
    return (xj - xi) * (yk - yi) - (yj - yi) * (xk - xi) > kFlatness * size * size;
  };
  std::vector<int> chain;
  const auto add = [&](int point, std::size_t bottom) {
    while (chain.size() >= bottom + 2 &&
           !turns_left(chain[chain.size() - 2], chain.back(), point)) {
      chain.pop_back();
    }
    chain.push_back(point);
  };
  for (const int point : order) add(point, 0);
  const std::size_t upper = chain.size() - 1;
  for (auto point = order.rbegin() + 1; point != order.rend(); ++point) add(*point, upper);
  chain.pop_back();
  return chain;
}

}  // namespace

MeshShape hull_surface(const ConvexHullShape& hull) {
  const Matrix3X<double>& x = hull.points;
  const int n = static_cast<int>(x.cols());
  const double size = n == 0 ? 0.0 : (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
  std::set<std::vector<int>> known;
  std::vector<Vector3<int>> triangles;
  Face face;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        if (!find_face(x, {i, j, k}, size, face) || !known.insert(face.points).second) continue;
        const std::vector<int> corners = outline(x, face, size);
        for (std::size_t c = 2; c < corners.size(); ++c) {
          triangles.emplace_back(corners[0], corners[c - 1], corners[c]);
        }
      }
    }
  }
  if (triangles.empty()) {
    throw InvalidArgument("convex hull: all " + std::to_string(n) +
                          " points lie in one plane, expected points around a volume");
  }
  MeshShape mesh{x, Triangles(3, static_cast<Eigen::Index>(triangles.size()))};
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  }
  return mesh;
}

}  // namespace weft::scenes
