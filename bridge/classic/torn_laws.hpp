#pragma once

// Tested by tests/bridge/tearing_test.cpp.

#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/implicit/bending_forces.hpp>
#include <weft/custom_forces/law_set.hpp>
#include <weft/fast_solver/network/spring_network.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The laws of a body for the mesh that a tear makes, before the body is torn (SoftBodySolver::laws_after()).
struct TornLaws {
  forces::LawSet<btScalar> laws;
  // For a fast body: its bending laws, and springs that replace all that have an end among the changed nodes (flags).
  BendingForces bending;
  fast::SpringNetwork springs;
  std::vector<char> is_changed;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
