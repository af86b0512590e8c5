#pragma once

namespace weft::bench {

/// A cloth of 8 x 8 nodes with a material, a weight, a time step and a fate drawn at random, uniform in the
/// exponent: thrown at a sphere on a floor, or pulled at a corner by a constant force.
struct RandomCloth {
  int number = 0;
  double time_step = 0.0;  ///< [s] 1/1000 to 1/30
  double stiffness = 0.0;  ///< [N/m] of each spring, 1 to 1e6
  double damping = 0.0;    ///< [N s/m] of each spring, 1e-6 to 10
  double bending = 0.0;    ///< [N m] rigidity of each hinge, 1e-7 to 1e-1
  double mass = 0.0;       ///< [kg] in all, 1e-3 to 100
  double friction = 0.0;   ///< [-] 0 to 1
  double speed = 0.0;      ///< [m/s] at the start, .1 to 20
  double pull = 0.0;       ///< [N] at a corner, .1 to 100 times the weight; 0: thrown
  bool is_pinned = false;  ///< at two corners
};

[[nodiscard]] RandomCloth random_cloth(int number);

/// Who steps it.
struct RandomClothSolver {
  enum class Kind {
    kFast,
    kLinks,  ///< Bullet's, with the stiffness that so many iterations make of them
    kLaws,   ///< explicit forces of the same springs: what explodes
  } kind = Kind::kFast;
  int iterations = 1;  ///< of links
};

/// Why a cloth counts as exploded. All that can move it is its start, gravity and the pull, whose work is summed
/// up; a contact with what stands still and an implicit step only take energy away.
struct Explosion {
  bool is_finite =
      true;  ///< places and speeds, and none beyond what freezes a body (SoftBodySolver::kMaxSpeed)
  /// Largest kinetic energy after any step over all that was put in until then [-].
  double energy_ratio = 0.0;
  double fastest = 0.0;  ///< [m/s] of any node
  /// Twice the energy is 1.4 times the speed that the whole cloth could have: neither rounding nor the
  /// truncation of a scheme of second order makes as much.
  [[nodiscard]] bool any() const { return !is_finite || energy_ratio > 2.0; }
};

/// Steps a cloth for half a second, at least 60 steps.
[[nodiscard]] Explosion run_random_cloth(const RandomCloth& cloth, const RandomClothSolver& solver);

}  // namespace weft::bench
