#include <weft/custom_forces/core/icosphere.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <weft/custom_forces/core/error.hpp>
#include <weft/custom_forces/core/hinges.hpp>

namespace weft {
namespace {

void require(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("icosphere: " + message);
}

void check(const Icosphere& sphere) {
  require(std::isfinite(sphere.radius) && sphere.radius > 0,
          "radius = " + std::to_string(sphere.radius) + " [m], expected > 0 and finite");
  require(sphere.frequency >= 1 && sphere.frequency <= 512,
          "frequency = " + std::to_string(sphere.frequency) + " [1], expected 1 to 512");
  require(sphere.center.allFinite(), "center is not finite, expected three lengths [m]");
  require(std::isfinite(sphere.total_mass) && sphere.total_mass > 0,
          "total_mass = " + std::to_string(sphere.total_mass) + " [kg], expected > 0 and finite");
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
  for (int i = 0; i < frequency; ++i) {
    for (int j = 0; i + j < frequency; ++j) {
      triangles.emplace_back(node(i, j), node(i + 1, j), node(i, j + 1));
      if (i + j + 1 < frequency) {
        triangles.emplace_back(node(i + 1, j), node(i + 1, j + 1), node(i, j + 1));
      }
    }
  }
}

}  // namespace

ClothMesh make_icosphere(const Icosphere& sphere) {
  check(sphere);
  NodeTable nodes;
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& face : kFaces) add_face(face, sphere.frequency, nodes, triangles);

  ClothMesh mesh;
  const auto num_nodes = static_cast<Eigen::Index>(nodes.directions().size());
  mesh.rest_positions.resize(3, num_nodes);
  for (Eigen::Index n = 0; n < num_nodes; ++n) {
    mesh.rest_positions.col(n) =
        sphere.center + sphere.radius * nodes.directions()[static_cast<std::size_t>(n)];
  }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  }
  mesh.edge_sets.push_back({"stretch", edges_of_triangles(mesh.triangles)});
  mesh.masses = node_areas(mesh);
  mesh.masses *= sphere.total_mass / mesh.masses.sum();
  return mesh;
}

}  // namespace weft
