#pragma once

#include <weft/bridge/bullet/precision.hpp>
#include <weft/fast_solver/network/spring_network.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Largest k h^2 / m that a step is solved with [-]: beyond, a node's inertia is lost in the rounding of its springs, and the
/// cloth falls slower than it should, or not at all. A spring at the limit yields by T h^2 / (1e6 m) under a
/// tension T: one that carries ten thousand nodes against gravity, by 0.03 mm at 1/60 s.
inline constexpr double kMostStiffness = sizeof(btScalar) == sizeof(float) ? 1e6 : 1e7;

/// Gives springs and dampers that are beyond the limit for a time step [s] the largest stiffness and damping below it; masses
/// of the nodes [kg], of which the lighter end counts. Says whether there were any.
bool limit_stiffness(double time_step, const VectorX<double>& masses, fast::SpringNetwork& network);

/// A body's springs change after they are made of its laws; this says how.
struct NetworkHistory {
  bool is_replaced = false;  ///< some of them, or masses: by a tear, or the program
  int num_new_rest_lengths = 0;
};

/// What a body keeps of it.
struct LimitedStiffness {
  fast::SpringNetwork
      as_given;  ///< as the laws say, if what is solved for is, or may have to be, limited; else empty
  btScalar asked_step = 0;  ///< [s] of the step in progress
  btScalar step = 0;        ///< [s] that stiffness is limited for
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
