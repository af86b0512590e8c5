#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <weft/custom_forces/force_law.hpp>

namespace weft::forces {

/// What happened while the laws of a body were evaluated. Numerical trouble is data, never an
/// exception.
struct ForceReport {
  std::optional<int>
      first_non_finite_node;  ///< set: the input was not finite there and nothing was added
  [[nodiscard]] bool ok() const { return !first_non_finite_node.has_value(); }
};

/// The laws that act on one body, with the scratch memory they share.
/// After the first call with a given number of nodes nothing is allocated.
template <class Scalar>
class LawSet {
 public:
  void add(std::unique_ptr<ForceLaw<Scalar>> law);
  [[nodiscard]] bool empty() const { return laws_.empty(); }
  [[nodiscard]] const std::vector<std::unique_ptr<ForceLaw<Scalar>>>& laws() const { return laws_; }

  /// How the velocity-level laws (dampers such as velocity_damping) take part.
  enum class VelocityLaws {
    kAsForces,  ///< they add their force like any other law
    kSeparate,  ///< they add nothing here; the engine calls advance_velocities at its proper place
    kAlone,     ///< they add their forces, and no other law does
  };

  /// forces += the sum of all laws [N]. Bit-identical for any number of threads.
  [[nodiscard]] ForceReport add_forces(const State<Scalar>& state, VelocityLaws velocity_laws,
                                       Matrix3XRef<Scalar> forces);

  /// Whether add_forces() may be asked for a state of some of the nodes, by several threads at the same time: all laws
  /// are pointwise, add forces and need no scratch memory.
  [[nodiscard]] bool is_node_by_node() const;

  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> product);
  /// Velocity-level laws take part as forces here.
  void add_damping_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
                           Matrix3XRef<Scalar> product);

  /// Applies every velocity-level law to velocities, in the order they were added, over time_step
  /// [s].
  void advance_velocities(const State<Scalar>& state, Scalar time_step,
                          Matrix3XRef<Scalar> velocities) const;

  /// Applies every inertia-level law to forces, the sum of all that acts on the body [N], or to a
  /// product of such a sum. Nothing happens if there is none. Engines call this last, but for
  /// forces of velocity-level laws: those state how fast velocities decay and are not slowed down,
  /// wherever they act. So the forces of a body are
  ///   add_forces(kSeparate), redistribute_forces, and, where they act as forces, add_forces(kAlone).
  void redistribute_forces(const State<Scalar>& state, Matrix3XRef<Scalar> forces) const;
  [[nodiscard]] bool has_level(LawTraits::Level level) const;

  /// Kinetic energy that the inertia-level laws store [J].
  [[nodiscard]] Scalar added_kinetic_energy(const State<Scalar>& state) const;
  [[nodiscard]] Scalar potential_energy(const State<Scalar>& state) const;
  [[nodiscard]] Scalar non_conservative_power(const State<Scalar>& state) const;

 private:
  std::vector<std::unique_ptr<ForceLaw<Scalar>>> laws_;
  Matrix3X<Scalar> scratch_;
};

}  // namespace weft::forces
