#include "tests/contract/sample.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>

namespace weft::contract {
namespace {

const Vector3<double> kAlong = Vector3<double>(1, 2, 2) / 3.0;
const Vector3<double> kAcross = Vector3<double>(2, 1, -2) / 3.0;
const Vector3<double> kCenter(0.3, -0.2, 0.5);  // [m]

/// Noise on positions in units of kSpacing [-]: makes no two springs alike, yet cannot bring a
/// spring of any Deformation near its rest length (nearest: the diagonals of kMixed, 7.7 % longer).
constexpr double kNoise = 0.01;
constexpr double kWaveHeight = 0.03;  // [m]

struct Ratios {
  double along;
  double across;
};

Ratios ratios_of(Deformation deformation) {
  switch (deformation) {
    case Deformation::kStretched:
      return {1.35, 1.3};
    case Deformation::kCompressed:
      return {0.7, 0.65};
    case Deformation::kMixed:
      break;
  }
  return {1.4, 0.6};
}

}  // namespace

ClothMesh sheet(int columns, int rows) {
  ClothGrid grid;
  grid.nodes = {columns, rows};
  grid.size = {kSpacing * (columns - 1), kSpacing * (rows - 1)};
  grid.center = kCenter;
  grid.u_axis = kAlong;
  grid.v_axis = kAcross;
  grid.total_mass = 0.7;
  ClothMesh mesh = make_cloth_grid(grid);
  if (columns > 2 && rows > 2) {
    const int middle = grid_node(grid, columns / 2, (rows - 1) / 2);
    std::vector<int> others;
    for (int node = 0; node < mesh.num_nodes(); ++node) {
      if (node != middle) others.push_back(node);
    }
    connect(mesh, "ties", middle, others);
    mesh.node_sets.push_back({"region", {0, 1, columns, mesh.num_nodes() - 1}});
  }
  return mesh;
}

ClothMesh battery_mesh(bool closed) {
  return closed ? make_icosphere({.radius = 0.3, .frequency = 2, .center = kCenter}) : sheet(5, 4);
}

ClothMesh large_battery_mesh(bool closed) {
  return closed ? make_icosphere({.radius = 2.4, .frequency = 12, .center = kCenter})
                : sheet(40, 40);
}

Matrix3X<double> random_directions(Eigen::Index n, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Matrix3X<double> values(3, n);
  for (double& value : values.reshaped()) {
    // Not std::uniform_real_distribution: its values differ between standard libraries.
    value = std::ldexp(static_cast<double>(generator() >> 11U), -52) - 1.0;
  }
  return values;
}

Sample<double> deformed(const ClothMesh& mesh, Deformation deformation, std::uint64_t seed) {
  const Ratios ratios = ratios_of(deformation);
  const Eigen::Index n = mesh.num_nodes();
  const Vector3<double> normal = kAlong.cross(kAcross);
  Sample<double> sample{kNoise * kSpacing * random_directions(n, 2 * seed),
                        random_directions(n, 2 * seed + 1), mesh.masses};
  for (Eigen::Index node = 0; node < n; ++node) {
    const Vector3<double> p = mesh.rest_positions.col(node) - kCenter;
    const double a = p.dot(kAlong);
    const double b = p.dot(kAcross);
    sample.positions.col(node) += kCenter + ratios.along * a * kAlong +
                                  ratios.across * b * kAcross +
                                  (p.dot(normal) + kWaveHeight * std::sin(7 * a + 5 * b)) * normal;
  }
  return sample;
}

Sample<double> at_rest(const ClothMesh& mesh) {
  return {mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes()), mesh.masses};
}

RigidPlacement oblique_placement() {
  const Eigen::AngleAxisd turn(1.1, Vector3<double>(2, -3, 6) / 7.0);
  return {turn.toRotationMatrix(), {-0.6, 0.9, 0.4}};
}

Sample<double> placed(const Sample<double>& sample, const RigidPlacement& placement) {
  return {(placement.rotation * sample.positions).colwise() + placement.shift,
          placement.rotation * sample.velocities, sample.masses};
}

Matrix3X<double> rigid_velocities(const Matrix3X<double>& positions) {
  const Vector3<double> spin(0.7, -0.4, 1.2);   // [rad/s]
  const Vector3<double> drift(0.5, 0.3, -0.8);  // [m/s]
  Matrix3X<double> velocities(3, positions.cols());
  for (Eigen::Index node = 0; node < positions.cols(); ++node) {
    velocities.col(node) = spin.cross(Vector3<double>(positions.col(node))) + drift;
  }
  return velocities;
}

}  // namespace weft::contract
