#pragma once

// Tested by tests/validation/theory_test.cpp.

#include <memory>
#include <vector>

#include <weft/custom_forces/law_info.hpp>
#include <weft/reference/solver.hpp>

namespace weft::validation {

/// Springs of one length in a row along direction, node 0 pinned at the origin: an oscillator (one
/// spring), a pendulum, a hanging chain.
struct SpringRow {
  int num_springs = 1;
  double spacing = 1.0;                ///< rest length [m]
  double mass = 1.0;                   ///< of every node [kg]
  Vector3<double> direction{1, 0, 0};  ///< unit vector
  std::vector<forces::LawSpecification> laws;
  bool flip_damping = false;  ///< sabotage: dissipative laws with the wrong sign
};

/// The row as a body at rest in its rest shape.
[[nodiscard]] reference::Body make_row(const SpringRow& row);

/// Free nodes with springs between some of them.
struct SpringBody {
  Matrix3X<double> positions;  ///< rest shape, 3 x n [m]
  Edges edges;                 ///< 2 x m
  VectorX<double> masses;      ///< n [kg]
  std::vector<forces::LawSpecification> laws;
  bool flip_damping = false;  ///< sabotage: dissipative laws with the wrong sign
};

/// The body at rest in its rest shape.
[[nodiscard]] reference::Body make_body(const SpringBody& springs);

[[nodiscard]] forces::LawSpecification tension_law(double stiffness);       ///< [N/m]
[[nodiscard]] forces::LawSpecification spring_damping_law(double damping);  ///< [N s/m]
[[nodiscard]] forces::LawSpecification velocity_damping_law(double rate);   ///< [1/s]
[[nodiscard]] forces::LawSpecification gravity_law(
    const Vector3<double>& acceleration);  ///< [m/s^2]

[[nodiscard]] forces::LawSpecification rotation_damping_law(double rate);            ///< [1/s]
[[nodiscard]] forces::LawSpecification torsional_rotation_damping_law(double rate);  ///< [1/s]
[[nodiscard]] forces::LawSpecification acceleration_damping_law(double beta);        ///< [-]

/// Solver of one body.
[[nodiscard]] reference::SpringSolver make_solver(reference::Body body,
                                                  reference::IntegratorKind integrator);

[[nodiscard]] const char* name_of(reference::IntegratorKind integrator);

}  // namespace weft::validation
