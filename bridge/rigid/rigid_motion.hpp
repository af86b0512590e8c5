#pragma once

// Tested by tests/bridge/implicit/fast_body_anchor_test.cpp.

#include <vector>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/rigid/movable_object.hpp>
#include <weft/core/eigen_alignment.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The generalized displacement of a rigid body: the translation of its center [m] and the rotation about it [rad].
using GeneralizedDisplacement = Eigen::Matrix<btScalar, 6, 1>;

/// A contact point of a dynamic body with an object that nothing moves: cloth cannot push the body into that object.
struct Support {
  MovableObject body;
  Vector3<btScalar> lever_arm;  ///< from the body's center [m]
  Vector3<btScalar> out;        ///< unit vector out of the other object
  bool is_loaded = false;       ///< the body is pushed into the other object

  /// How far the contact point moves out of the other object [m].
  [[nodiscard]] btScalar displacement_out(const GeneralizedDisplacement& displacement) const;
};

/// Appends the points in which a body rests on such objects or leans on them, by the last look of the dispatcher (if any),
/// before Bullet has moved it over time_step [s]: within reach [m], and no faster than reach a step.
void add_supports(const MovableObject& body, btDispatcher* dispatcher, btScalar time_step,
                  btScalar reach, std::vector<Support>& supports);

/// Decides for each support whether it is loaded, from the displacement of the body in a solution to which the loaded ones
/// were immovable. True if any has changed. least: how far a body may move into another without loading it [m].
bool update_loads(const MovableObject& body, const GeneralizedDisplacement& displacement,
                  btScalar least, std::vector<Support>& supports);

/// The inertia that loaded supports add to a body, so that it does not move there [kg, kg m, kg m^2].
[[nodiscard]] Eigen::Matrix<btScalar, 6, 6> inertia_of_supports(
    const MovableObject& body, const std::vector<Support>& supports);

/// Moves an object by what a change of its velocities makes of a step, unless it hangs on a joint or is not
/// simulated. What holds a body, a joint or friction on what it touches, would take that velocity away before Bullet moves it.
void move_at_once(const MovableObject& body, const RigidVelocity& last_velocity,
                  btScalar time_step);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
