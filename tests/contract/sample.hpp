#pragma once

#include <array>
#include <cstdint>

#include <weft/custom_forces/force_law.hpp>
#include <weft/mesh/cloth_mesh.hpp>

#include "tests/contract/dual/dual.hpp"

namespace weft::contract {

/// Owns what a State refers to.
template <class Scalar>
struct Sample {
  Matrix3X<Scalar> positions;   ///< 3 x n [m]
  Matrix3X<Scalar> velocities;  ///< 3 x n [m/s]
  VectorX<Scalar> masses;       ///< n [kg]

  [[nodiscard]] forces::State<Scalar> state() const { return {positions, velocities, masses}; }
  [[nodiscard]] Eigen::Index num_nodes() const { return positions.cols(); }
};

template <class To, class From>
[[nodiscard]] Sample<To> cast(const Sample<From>& sample) {
  return {sample.positions.template cast<To>(), sample.velocities.template cast<To>(),
          sample.masses.template cast<To>()};
}

/// How a sample deforms the sheet. In each every spring is longer or shorter than at rest by far
/// more than the steps of the difference formulas: a law may switch at its rest length.
enum class Deformation { kStretched, kCompressed, kMixed };
inline constexpr std::array kDeformations = {Deformation::kStretched, Deformation::kCompressed,
                                             Deformation::kMixed};

/// Distance of neighbors in the battery's sheet [m].
inline constexpr double kSpacing = 0.2;

/// A sheet of 5 x 4 nodes, 24-neighbour springs, in an oblique plane off the origin; for laws that
/// need a closed surface a sphere of 42 nodes.
[[nodiscard]] ClothMesh battery_mesh(bool closed);
/// The same with about 1600 nodes, for the thread tests: many chunks.
[[nodiscard]] ClothMesh large_battery_mesh(bool closed);

/// The same plane and spacing, columns x rows nodes, with connections from a node in the middle and a region
/// of four nodes.
[[nodiscard]] ClothMesh sheet(int columns, int rows);

/// Waved and noisy, with random velocities of about 1 m/s. mesh must be one of those above.
[[nodiscard]] Sample<double> deformed(const ClothMesh& mesh, Deformation deformation,
                                      std::uint64_t seed = 1);

/// The rest shape at rest.
[[nodiscard]] Sample<double> at_rest(const ClothMesh& mesh);

/// 3 x n numbers in [-1, 1], the same for the same seed on every machine.
[[nodiscard]] Matrix3X<double> random_directions(Eigen::Index n, std::uint64_t seed);

/// A rotation about an oblique axis and a shift by about the size of the sheet.
struct RigidPlacement {
  Matrix3<double> rotation;
  Vector3<double> shift;  ///< [m]
};
[[nodiscard]] RigidPlacement oblique_placement();
[[nodiscard]] Sample<double> placed(const Sample<double>& sample, const RigidPlacement& placement);

/// Velocities of a rigid motion: omega x r + v0, 3 x n [m/s].
[[nodiscard]] Matrix3X<double> rigid_velocities(const Matrix3X<double>& positions);

}  // namespace weft::contract
