#include <weft/mesh/icosphere.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <weft/core/error.hpp>

namespace weft {
namespace {

void require_sphere(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("icosphere: " + message);
}

void check(const Icosphere& sphere) {
  require_sphere(std::isfinite(sphere.radius) && sphere.radius > 0,
                 "radius = " + std::to_string(sphere.radius) + " [m], expected > 0 and finite");
  require_sphere(sphere.frequency >= 1 && sphere.frequency <= 512,
                 "frequency = " + std::to_string(sphere.frequency) + " [1], expected 1 to 512");
  require_sphere(sphere.center.allFinite(), "center is not finite, expected three lengths [m]");
  // 1e-6: far above the rounding of a unit quaternion, far below anything visible.
  require_sphere(std::abs(sphere.orientation.norm() - 1) < 1e-6,
                 "orientation is no unit quaternion, expected one");
}

// Corners of an icosahedron: the four (0, +-1, +-golden ratio) and their cyclic permutations.
constexpr double kGolden = 1.6180339887498949;
constexpr std::array<std::array<double, 3>, 12> kCorners = {{{-1, kGolden, 0},
                                                             {1, kGolden, 0},
                                                             {-1, -kGolden, 0},
                                                             {1, -kGolden, 0},
                                                             {0, -1, kGolden},
                                                             {0, 1, kGolden},
                                                             {0, -1, -kGolden},
                                                             {0, 1, -kGolden},
                                                             {kGolden, 0, -1},
                                                             {kGolden, 0, 1},
                                                             {-kGolden, 0, -1},
                                                             {-kGolden, 0, 1}}};
constexpr std::array<std::array<int, 3>, 20> kFaces = {
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

/// Gives every lattice point of every face one node: points on shared edges and corners meet.
class NodeTable {
 public:
  /// The node at the corners' mean with these weights (they sum to the frequency).
  int node(const std::array<int, 3>& corners, const std::array<int, 3>& weights) {
    std::vector<std::pair<int, int>> key;
    Vector3<double> position = Vector3<double>::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      if (weights[k] == 0) continue;
      key.emplace_back(corners[k], weights[k]);
      const auto& corner = kCorners[static_cast<std::size_t>(corners[k])];
      position += weights[k] * Vector3<double>(corner[0], corner[1], corner[2]);
    }
    std::sort(key.begin(), key.end());
    const auto [found, is_new] = index_.emplace(key, static_cast<int>(directions_.size()));
    if (is_new) directions_.push_back(position.normalized());
    return found->second;
  }
  [[nodiscard]] const std::vector<Vector3<double>>& directions() const { return directions_; }

 private:
  std::map<std::vector<std::pair<int, int>>, int> index_;
  std::vector<Vector3<double>> directions_;
};

void add_face(const std::array<int, 3>& corners, int frequency, NodeTable& nodes,
              std::vector<Eigen::Vector3i>& triangles) {
  const auto node = [&](int i, int j) { return nodes.node(corners, {frequency - i - j, i, j}); };
  // Nodes are numbered as they are met: the last corner of a triangle first. In statements of their own, for compilers
  // differ in the order in which they take the arguments of a call, and recordings name nodes by number.
  const auto add = [&](std::array<int, 2> a, std::array<int, 2> b, std::array<int, 2> c) {
    const int third = node(c[0], c[1]);
    const int second = node(b[0], b[1]);
    const int first = node(a[0], a[1]);
    triangles.emplace_back(first, second, third);
  };
  for (int i = 0; i < frequency; ++i) {
    for (int j = 0; i + j < frequency; ++j) {
      add({i, j}, {i + 1, j}, {i, j + 1});
      if (i + j + 1 < frequency) {
        add({i + 1, j}, {i + 1, j + 1}, {i, j + 1});
      }
    }
  }
}

/// Longitude as a part of a turn, in [0, 1), and latitude from pole to pole, 0 to 1.
Eigen::Vector2d place_on_map(const Vector3<double>& direction) {
  const double turn = std::atan2(-direction.z(), direction.x()) / (2 * std::numbers::pi);
  const double latitude = std::asin(std::clamp(direction.y(), -1.0, 1.0)) / std::numbers::pi;
  return {turn < 0 ? turn + 1 : turn, latitude + 0.5};
}

bool is_pole(const Vector3<double>& direction) {
  constexpr double kRoundoff = 1e-12;  // far below the distance of any two nodes
  return std::hypot(direction.x(), direction.z()) < kRoundoff;
}

/// Places of a triangle's corners side by side: beyond the seam longitude goes on above 1, and a
/// pole, which has none, gets that of the middle of the other two.
void place_corners(const std::array<Vector3<double>, 3>& directions,
                   Eigen::Ref<Matrix2X<double>> corners) {
  double largest = 0;
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Vector3<double>& direction = directions[static_cast<std::size_t>(c)];
    corners.col(c) = place_on_map(direction);
    if (!is_pole(direction)) largest = std::max(largest, corners(0, c));
  }
  for (Eigen::Index c = 0; c < 3; ++c) {
    if (largest - corners(0, c) > 0.5) corners(0, c) += 1;
  }
  for (Eigen::Index c = 0; c < 3; ++c) {
    if (!is_pole(directions[static_cast<std::size_t>(c)])) continue;
    corners(0, c) = 0.5 * (corners(0, (c + 1) % 3) + corners(0, (c + 2) % 3));
  }
}

Surface make_surface(const Icosphere& sphere) {
  check(sphere);
  NodeTable nodes;
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& face : kFaces) add_face(face, sphere.frequency, nodes, triangles);
  const std::vector<Vector3<double>>& directions = nodes.directions();

  Surface surface;
  surface.positions.resize(3, static_cast<Eigen::Index>(directions.size()));
  for (std::size_t n = 0; n < directions.size(); ++n) {
    surface.positions.col(static_cast<Eigen::Index>(n)) =
        sphere.center + sphere.orientation * (sphere.radius * directions[n]);
  }
  const auto num_triangles = static_cast<Eigen::Index>(triangles.size());
  surface.triangles.resize(3, num_triangles);
  surface.corner_texture_coordinates.resize(2, 3 * num_triangles);
  for (Eigen::Index t = 0; t < num_triangles; ++t) {
    const Eigen::Vector3i& corners = triangles[static_cast<std::size_t>(t)];
    surface.triangles.col(t) = corners;
    const auto direction = [&](int c) { return directions[static_cast<std::size_t>(corners[c])]; };
    place_corners({direction(0), direction(1), direction(2)},
                  surface.corner_texture_coordinates.middleCols(3 * t, 3));
  }
  return surface;
}

}  // namespace

ClothMesh make_icosphere(const Icosphere& sphere) {
  return make_surface_body(make_surface(sphere),
                           {sphere.total_mass, sphere.lumping, sphere.center_mass_share});
}

double surface_area(const Icosphere& sphere) {
  return surface_area(make_surface(sphere));
}

}  // namespace weft
