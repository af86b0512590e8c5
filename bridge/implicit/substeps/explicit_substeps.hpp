#pragma once

// Tested by tests/bridge/implicit/fast_body_impact_test.cpp, tests/bridge/implicit/substeps/substep_count_test.cpp.

#include <memory>
#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/implicit/bending_forces.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// A stable step of symplectic Euler with these springs and this bending [s]: a share of 2 over the largest angular frequency,
/// which Gershgorin's theorem bounds. 0 with dampers, which make it shorter, and without springs.
[[nodiscard]] btScalar stable_step(const fast::SpringNetwork& network,
                                   const VectorX<double>& masses);

/// Substeps by symplectic Euler: forces of springs and bending are those at the start of the substep, and a solver of a network
/// without springs finds contacts, friction and the motion of two-way coupled bodies.
class ExplicitSubsteps {
 public:
  using Solver = fast::ImplicitSolver<btScalar>;

  ExplicitSubsteps(const fast::SpringNetwork& network, const VectorX<double>& masses)
      : stable_step_(stable_step(network, masses)) {}

  /// How many are stable in a step [s]; the largest number if none are.
  [[nodiscard]] btScalar count(btScalar time_step) const;
  /// The cloth has torn: its springs are not looked at again, and no substep counts as stable.
  void forget();
  /// Before the first substep of a step; contact states are those of the solver of whole steps. pins: nodes that are not free.
  void begin(const Solver& whole_steps, const VectorX<double>& masses,
             const std::vector<bool>& is_free, const std::vector<int>& pins);
  /// Forces at the positions at which a substep starts, 3 x n [m]. bending counts from the start of the whole step.
  void find_forces(Solver& whole_steps, const BendingForces& bending,
                   const Matrix3X<btScalar>& starts, fast::WorkerTeam& team);
  /// The inertial positions [m] of some consecutive nodes, with velocities [m/s] without springs.
  void set_targets(int begin, int count, btScalar time_step, const VectorX<double>& masses,
                   const Matrix3X<btScalar>& starts, const Matrix3X<btScalar>& velocities,
                   Matrix3X<btScalar>& targets);
  /// The rounding of these positions, 3 x count [m]. In a substep nodes move by a few thousand units in the last place of
  /// their positions, and velocities keep that.
  [[nodiscard]] auto target_rounding(int begin, int count) const {
    return target_rounding_.middleCols(begin, count);
  }
  [[nodiscard]] Solver& solver() { return *solver_; }

  void serialize(StateArchive& archive) { archive.value(stable_step_); }

 private:
  btScalar stable_step_;  ///< [s]; 0: none
  std::unique_ptr<Solver> solver_;
  std::vector<int> pins_;  ///< that solver_ knows
  Matrix3X<btScalar> forces_;
  Matrix3X<btScalar> target_rounding_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
