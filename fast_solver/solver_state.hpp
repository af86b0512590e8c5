#pragma once

// Tested by tests/bridge/snapshot_test.cpp, tests/engines/snapshot_test.cpp.

#include <vector>

#include <weft/core/state_archive.hpp>
#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::fast {

/// What a snapshot asks of a solver.
struct SolverState {
  /// What a step knows of the one before: contact states. For a solver of the same network and free nodes.
  template <class Scalar>
  static void serialize(StateArchive& archive, ImplicitSolver<Scalar>& solver);

  /// Whether a new solver of the same network, pins and masses would do the same, to the bit: the coarse space of cloth that has
  /// torn is that of the cloth before.
  template <class Scalar>
  [[nodiscard]] static bool is_fresh(const ImplicitSolver<Scalar>& solver) {
    return !solver.has_torn_;
  }
};

extern template void SolverState::serialize(StateArchive&, ImplicitSolver<float>&);
extern template void SolverState::serialize(StateArchive&, ImplicitSolver<double>&);

}  // namespace weft::fast
