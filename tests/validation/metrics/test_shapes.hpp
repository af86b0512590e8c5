#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include <weft/mesh/cloth_grid.hpp>

namespace weft::validation {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Round-off of a handful of operations on numbers of size 1 to 10: 100 eps, relative or absolute.
inline constexpr double kRoundoff = 100 * kEpsilon;

/// Fixed pseudo-random numbers in [-1, 1): the same on every machine (splitmix64).
class Sequence {
 public:
  explicit Sequence(std::uint64_t seed) : state_(seed) {}
  double next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
  }
  Vector3<double> vector() {
    const double x = next();
    const double y = next();
    return {x, y, next()};
  }
  Matrix3X<double> columns(Eigen::Index n) {
    Matrix3X<double> result(3, n);
    for (Eigen::Index i = 0; i < n; ++i) result.col(i) = vector();
    return result;
  }

 private:
  std::uint64_t state_;
};

/// A flat cloth, size x size [m], n x n nodes, in the plane y = height [m].
inline ClothMesh flat_cloth(int n, double size, double height = 0.0) {
  ClothGrid grid;
  grid.nodes = {n, n};
  grid.size = {size, size};
  grid.center = {0, height, 0};
  return make_cloth_grid(grid);
}

/// A flat disc in the plane y = 0 around the y axis: rings of nodes around a centre node.
inline ClothMesh flat_disc(int num_rings, int num_sectors, double radius) {
  ClothMesh mesh;
  mesh.rest_positions.resize(3, 1 + num_rings * num_sectors);
  mesh.rest_positions.col(0).setZero();
  for (int ring = 0; ring < num_rings; ++ring) {
    for (int sector = 0; sector < num_sectors; ++sector) {
      const double r = radius * (ring + 1) / num_rings;
      const double phi = 2 * std::numbers::pi * sector / num_sectors;
      mesh.rest_positions.col(1 + ring * num_sectors + sector) =
          Vector3<double>(r * std::cos(phi), 0, r * std::sin(phi));
    }
  }
  mesh.triangles.resize(3, num_sectors * (2 * num_rings - 1));
  Eigen::Index t = 0;
  for (int sector = 0; sector < num_sectors; ++sector) {
    const int next = (sector + 1) % num_sectors;
    mesh.triangles.col(t++) << 0, 1 + sector, 1 + next;
    for (int ring = 1; ring < num_rings; ++ring) {
      const int inner = 1 + (ring - 1) * num_sectors;
      const int outer = inner + num_sectors;
      mesh.triangles.col(t++) << inner + sector, outer + sector, outer + next;
      mesh.triangles.col(t++) << inner + sector, outer + next, inner + next;
    }
  }
  mesh.masses = VectorX<double>::Ones(mesh.rest_positions.cols());
  return mesh;
}

}  // namespace weft::validation
