#pragma once

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "tests/custom_forces/one_law.hpp"

namespace weft::forces {

/// Seven nodes without any symmetry, masses from 0.5 to 2 kg, a metre across, off the origin.
inline ClothMesh lopsided_body() {
  Matrix3X<double> positions(3, 7);
  positions << 0.1, 0.9, 0.4, -0.3, 0.2, 0.7, -0.1,  //
      2.0, 2.1, 2.8, 2.4, 1.5, 1.9, 2.3,             //
      -0.5, -0.2, -0.7, -0.4, 0.1, 0.3, -1.0;
  ClothMesh mesh = small_mesh(positions, Edges(2, 0));
  mesh.masses << 0.5, 2.0, 1.1, 0.7, 1.6, 0.9, 1.3;
  return mesh;
}

/// Fixed numbers in [-1, 1].
inline Matrix3X<double> arbitrary(Eigen::Index num_nodes, unsigned seed) {
  std::mt19937 generator(seed);
  Matrix3X<double> values(3, num_nodes);
  for (double& value : values.reshaped()) {
    value = std::ldexp(static_cast<double>(generator()), -31) - 1.0;
  }
  return values;
}

inline Vector3<double> center_of_mass(const ClothMesh& mesh) {
  return mesh.rest_positions * mesh.masses / mesh.masses.sum();
}

/// P [kg m/s].
inline Vector3<double> momentum(const ClothMesh& mesh, const Matrix3X<double>& velocities) {
  return velocities * mesh.masses;
}

/// L about the centre of mass of the rest shape [kg m^2/s].
inline Vector3<double> spin_momentum(const ClothMesh& mesh, const Matrix3X<double>& velocities) {
  const Vector3<double> center = center_of_mass(mesh);
  Vector3<double> sum = Vector3<double>::Zero();
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const Vector3<double> r = mesh.rest_positions.col(node) - center;
    sum += mesh.masses[node] * r.cross(Vector3<double>(velocities.col(node)));
  }
  return sum;
}

/// omega x r + drift about the origin [m/s].
inline Matrix3X<double> rigid_motion(const ClothMesh& mesh, const Vector3<double>& omega,
                                     const Vector3<double>& drift) {
  Matrix3X<double> velocities(3, mesh.num_nodes());
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    velocities.col(node) = omega.cross(Vector3<double>(mesh.rest_positions.col(node))) + drift;
  }
  return velocities;
}

/// Velocities after a velocity-level law has acted over time_step [s] on the mesh at rest.
inline Matrix3X<double> advanced(const LawSpecification& specification, const ClothMesh& mesh,
                                 const Matrix3X<double>& velocities, double time_step) {
  const auto law = make_law<double>(specification, mesh);
  Matrix3X<double> result = velocities;
  law->advance_velocities({mesh.rest_positions, velocities, mesh.masses}, time_step, result);
  return result;
}

}  // namespace weft::forces
