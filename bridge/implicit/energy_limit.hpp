#pragma once

// Tested by tests/bridge/implicit/fast_body_test.cpp, tests/bridge/implicit/explosion_test.cpp.

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/types.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The result of a step of a body on which nothing that moves does work (pins, anchors, moving colliders). All 3 x n.
struct StepMotion {
  const Matrix3X<btScalar>& masses;            ///< each thrice [kg]; 0 for pinned nodes
  const Matrix3X<btScalar>& starts;            ///< [m]
  const Matrix3X<btScalar>& start_velocities;  ///< [m/s]
  const Matrix3X<btScalar>& predicted;         ///< velocities after all that is not implicit [m/s]
  const Matrix3X<btScalar>& positions;         ///< [m] at the end
  btScalar time_step;                          ///< [s]
};

/// Kinetic energy that the free nodes had, and the work over the step's displacement of all forces that are not implicit [J].
/// Summed by a team, with the same bits for any; so is kinetic_energy().
[[nodiscard]] double energy_put_in(const StepMotion& motion, fast::WorkerTeam& team);

/// Kinetic energy of the free nodes with velocities [m/s]. masses as in StepMotion.
[[nodiscard]] double kinetic_energy(const Matrix3X<btScalar>& masses,
                                    const Matrix3X<btScalar>& velocities, fast::WorkerTeam& team);

/// Slows velocities down to a kinetic energy of `most` [J]. That of the centre of mass stays if keeps_momentum,
/// and then `most` is only reached as far as it allows.
void limit_energy(const Matrix3X<btScalar>& masses, double most, bool keeps_momentum,
                  Matrix3X<btScalar>& velocities, fast::WorkerTeam& team);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
