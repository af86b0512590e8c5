#pragma once

// Tested by tests/bridge/implicit/fast_body_anchor_test.cpp.

#include <vector>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/eigen_alignment.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// A motion of a rigid body: of its centre [m], about it [rad].
using RigidWay = Eigen::Matrix<btScalar, 6, 1>;

/// Where a dynamic body touches an object that nothing moves: cloth cannot push it that way.
struct Support {
  const btRigidBody* body;
  Vector3<btScalar> lever_arm;  ///< from the body's centre [m]
  Vector3<btScalar> out;        ///< unit vector out of the other object
  bool is_loaded = false;       ///< the body is pushed into the other object

  /// How far the place moves out of the other object [m].
  [[nodiscard]] btScalar way_out(const RigidWay& way) const;
};

/// Appends the points in which a body rests on such objects or leans on them, by the last look of the dispatcher (if any),
/// before Bullet has moved it over time_step [s]: within reach [m], and no faster than reach a step.
void add_supports(const btRigidBody& body, btDispatcher* dispatcher, btScalar time_step,
                  btScalar reach, std::vector<Support>& supports);

/// Whether each is loaded, from how the body gave way in a solution that took those for immovable that were. True if any
/// has changed. least: what a body may be led into another without that [m].
bool update_loads(const btRigidBody& body, const RigidWay& way, btScalar least,
                  std::vector<Support>& supports);

/// The inertia that loaded supports add to a body, so that it does not move there [kg, kg m, kg m^2].
[[nodiscard]] Eigen::Matrix<btScalar, 6, 6> inertia_of_supports(
    const btRigidBody& body, const std::vector<Support>& supports);

/// Moves a dynamic body by what a change of its velocities makes of a step, unless it hangs on a joint or does not take
/// part. What holds a body, a joint or friction on what it touches, would take that velocity away before Bullet moves it.
void move_at_once(btRigidBody& body, const btVector3& last_velocity,
                  const btVector3& last_angular_velocity, btScalar time_step);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
