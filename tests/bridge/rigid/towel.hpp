#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {

inline constexpr double kTowelMass = 0.1;      // [kg]
inline constexpr double kTowelFriction = 0.5;  // times 1 of the fingers, on both sides of the towel
inline constexpr double kGripThreshold =
    9.81 * kTowelMass / (2 * kTowelFriction);  // [N] of the grip
/// [N/m] From that of a knitted towel to that of woven cloth.
inline constexpr std::array kTowelStiffness{200.0, 2000.0, 20000.0};
inline constexpr double kTowelMargin = 0.004;  // [m]
inline constexpr int kTowelNodes = 17;         // along each side
inline constexpr double kTowelSize = 0.4;      // [m]

/// It hangs in the plane x = 0 from y = 0 down, by two corners.
inline ClothMesh towel(unsigned seed) {
  ClothMesh mesh = cloth(kTowelNodes, kTowelSize, 0, kTowelMass);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-1e-3, 1e-3);
  for (Eigen::Index i = 0; i < mesh.rest_positions.cols(); ++i) {
    const Vector3<double> flat = mesh.rest_positions.col(i);
    mesh.rest_positions.col(i) =
        Vector3<double>(shift(random), flat.z() - kTowelSize / 2, flat.x() + 0.1 * shift(random));
  }
  return mesh;
}

inline std::vector<int> top_corners(const ClothMesh& mesh) {
  std::vector<int> corners;
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    const Vector3<double> x = mesh.rest_positions.col(i);
    if (x.y() > -1e-3 && std::abs(std::abs(x.z()) - kTowelSize / 2) < 2e-3) corners.push_back(i);
  }
  return corners;
}

/// The node in the middle of the upper rim.
inline int middle(const ClothMesh& mesh) {
  int best = 0;
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    const Vector3<double> goal(0, -0.02, 0);
    if ((mesh.rest_positions.col(i) - goal).norm() <
        (mesh.rest_positions.col(best) - goal).norm()) {
      best = i;
    }
  }
  return best;
}

}  // namespace weft::bridge
