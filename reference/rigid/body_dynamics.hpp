#pragma once

// Tested by tests/reference/integrators_test.cpp, tests/reference/prescribed_motion_test.cpp.

#include <optional>

#include <weft/reference/system.hpp>

namespace weft::reference {

/// What an integrator sees of a body: accelerations, and the exact action of its velocity-level
/// laws.
class BodyDynamics {
 public:
  explicit BodyDynamics(Body& body);

  using VelocityLaws = forces::LawSet<double>::VelocityLaws;

  /// Time at the start of the step [s].
  void set_time(double time) { time_ = time; }

  /// accelerations = M^-1 f(positions, velocities) [m/s^2], 0 for pinned nodes. time_in_step: [s]
  /// since the start of the step, for laws with targets that move. Inertia-level laws redistribute the
  /// forces of all laws but those of velocity level, whose rates are those of the velocities in every
  /// integrator.
  void evaluate(ConstMatrix3XRef<double> positions, ConstMatrix3XRef<double> velocities,
                double time_in_step, VelocityLaws velocity_laws, Matrix3XRef<double> accelerations);

  /// Applies the velocity-level laws alone over time_step [s]; pinned nodes keep their velocity.
  void advance_velocities(ConstMatrix3XRef<double> positions, double time_step,
                          Matrix3X<double>& velocities);

  /// Which laws a product with the derivative of the forces holds.
  enum class Reach {
    kAll,    ///< every law
    kShort,  ///< laws of springs, lines, hinges and faces: what a sparse matrix can hold
  };
  /// product = df/dx displacements + df/dv velocity_changes [N], every law as a force, 3 x n.
  /// Inertia-level laws redistribute it as they do the forces; that their own share depends on the
  /// positions is left out. velocity_changes are those of free nodes.
  void multiply_jacobian(Reach reach, ConstMatrix3XRef<double> positions,
                         ConstMatrix3XRef<double> velocities, double time_in_step,
                         ConstMatrix3XRef<double> displacements,
                         ConstMatrix3XRef<double> velocity_changes, Matrix3XRef<double> product);

  [[nodiscard]] const Body& body() const { return *body_; }
  [[nodiscard]] const VectorX<double>& inverse_masses() const { return inverse_masses_; }

  /// First node whose state was not finite in any evaluation so far.
  [[nodiscard]] std::optional<int> first_non_finite_node() const { return first_non_finite_node_; }

 private:
  Body* body_;
  VectorX<double> inverse_masses_;  // 0 for pinned nodes
  Matrix3X<double> before_;         // velocities as the velocity-level laws see them
  Matrix3X<double> scratch_;        // of laws that are asked one by one
  double time_ = 0.0;               // [s]
  std::optional<int> first_non_finite_node_;
};

}  // namespace weft::reference
