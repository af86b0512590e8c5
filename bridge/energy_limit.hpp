#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/precision.hpp>
#include <weft/custom_forces/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// What a step did, of a body on which nothing that moves does work (pins, anchors, moving obstacles).
struct StepMotion {
  const VectorX<double>& masses;               ///< n [kg]
  const Matrix3X<btScalar>& starts;            ///< 3 x n [m]
  const Matrix3X<btScalar>& start_velocities;  ///< 3 x n [m/s]
  const Matrix3X<btScalar>& places;            ///< 3 x n [m] at the end
  btScalar time_step;                          ///< [s]
};

/// Kinetic energy that the free nodes had, and the work on the step's way of all that is not implicit [J]: of the
/// change of velocity that btSoftBody::predictMotion has put into m_v.
[[nodiscard]] double energy_put_in(const StepMotion& motion, const btSoftBody& body);

/// Kinetic energy of the free nodes with velocities, 3 x n [m/s].
[[nodiscard]] double kinetic_energy(const VectorX<double>& masses, const btSoftBody& body,
                                    const Matrix3X<btScalar>& velocities);

/// Slows velocities down to a kinetic energy of `most` [J]. That of the centre of mass stays if keeps_momentum,
/// and then `most` is only reached as far as it allows.
void limit_energy(const VectorX<double>& masses, const btSoftBody& body, double most,
                  bool keeps_momentum, Matrix3X<btScalar>& velocities);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
