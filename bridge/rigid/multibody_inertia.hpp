#pragma once

// Tested by tests/bridge/rigid/multibody_test.cpp.

#include <span>
#include <vector>

#include <Eigen/Core>

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/rigid/movable_object.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Whether impulses on a link (-1: the base) move it: its base or a joint on the way to it is free, and not led by the program.
[[nodiscard]] bool is_link_movable(const btMultiBody& multibody, int link);

/// Whether nothing but its links holds the base.
[[nodiscard]] bool is_base_free(const btMultiBody& multibody);

/// [kg] Of a link; of one without a mass of its own, as robots have, a hundredth of what moves in its multibody.
[[nodiscard]] double reference_mass(const btMultiBody& multibody, int link);

/// The velocity of a link by those of base and joints; `center` stays empty.
[[nodiscard]] RigidVelocity link_velocity(const btMultiBody& multibody, int link);

/// The inertia of a multibody in its present pose, seen from its links: the joint-space inertia matrix (Featherstone 2008) and
/// the inverse operational-space inertia of links (Khatib 1987). Bullet's own articulated-body factors belong to the pose in
/// which the step began.
///
/// Generalised velocities have Bullet's order: base rotation, base translation, joints. Those that the program leads (a fixed
/// or kinematic base, kinematic links) do not respond.
class MultiBodyInertia {
 public:
  explicit MultiBodyInertia(const btMultiBody& multibody);

  [[nodiscard]] const btMultiBody& multibody() const { return *multibody_; }
  /// 6 x n: translation and rotation of a link's center per generalised velocity.
  [[nodiscard]] Eigen::MatrixXd jacobian_of(int link) const;
  /// The change of the generalised velocities by a generalised impulse.
  [[nodiscard]] VectorX<double> response_to(const VectorX<double>& impulse) const;
  /// [J] Of all links, with the present velocities.
  [[nodiscard]] double kinetic_energy() const;
  /// [J] That a generalised impulse would add.
  [[nodiscard]] double energy_gain(const VectorX<double>& impulse) const;
  /// The inertia of some links, 6 per link, together: (J M^-1 J^T)^-1. In directions in which joints do not let them move it is
  /// kNoTranslation times a link's mass, and 100 m^2 times that for rotations.
  [[nodiscard]] Eigen::MatrixXd inertia_of(std::span<const int> links) const;

 private:
  struct Frame {
    Matrix3<double> rotation;  ///< from the link to the world
    Vector3<double> center;    ///< [m]
  };
  [[nodiscard]] VectorX<double> velocities() const;
  void add_link(int link);

  const btMultiBody* multibody_;
  std::vector<Frame> frames_;  ///< of base and links
  Eigen::MatrixXd inertia_;    ///< joint-space, of all coordinates
  Eigen::MatrixXd inverse_;    ///< zero for those that are led
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
