#pragma once

#include <weft/core/parallel/task_group.hpp>
#include <weft/custom_forces/law_set.hpp>

namespace weft::forces {

/// The forces of the next step, computed by other threads while the caller does something else.
///
///   DeferredForces<float> deferred(laws, LawSet<float>::VelocityLaws::kAsForces);
///   deferred.begin(state);             // positions are final: other threads start at once
///   ...                                // the rest of the frame
///   deferred.finish(state, forces);    // helps with what is left, and hands the forces over
///
/// After Werth: at the end of a frame all positions are known, so the forces of the next one need
/// not wait for it. The forces are those of LawSet::add_forces, bit for bit: if finish() is given
/// another state than begin(), down to one bit, they are computed anew.
///
/// Threads   begin() and finish() are for one thread; what is in between may be anything, parallel
///           or not. With one thread (num_threads()) nothing runs before finish().
/// Lifetime  the laws must outlive this object and must not be used between begin() and finish().
///           The state is copied: its owner may be gone before finish().
template <class Scalar>
class DeferredForces {
 public:
  using VelocityLaws = typename LawSet<Scalar>::VelocityLaws;

  DeferredForces(LawSet<Scalar>& laws, VelocityLaws velocity_laws)
      : laws_(laws), velocity_laws_(velocity_laws) {}
  /// Drops what is in flight, as drop().
  ~DeferredForces() noexcept { drop(); }
  DeferredForces(const DeferredForces&) = delete;
  DeferredForces& operator=(const DeferredForces&) = delete;

  /// Copies the state and starts its forces. What was in flight before is dropped.
  void begin(const State<Scalar>& state);

  /// forces = the sum of all laws for state, 3 x n [N]; their memory is exchanged, not copied.
  /// Computes them here and now if begin() was not called. Throws what a law throws.
  [[nodiscard]] ForceReport finish(const State<Scalar>& state, Matrix3X<Scalar>& forces);

  /// Forgets the forces in flight, waiting only for chunks that have started.
  void drop() noexcept;

  [[nodiscard]] bool is_in_flight() const { return is_in_flight_; }
  /// How often finish() met another state than begin() and had to compute again.
  [[nodiscard]] long num_recomputed() const { return num_recomputed_; }

 private:
  [[nodiscard]] bool is_state_of_begin(const State<Scalar>& state) const;
  void compute(const State<Scalar>& state);

  LawSet<Scalar>& laws_;
  VelocityLaws velocity_laws_;
  Matrix3X<Scalar> positions_;   ///< [m] of begin()
  Matrix3X<Scalar> velocities_;  ///< [m/s] of begin()
  VectorX<Scalar> masses_;       ///< [kg] of begin()
  double time_ = 0.0;            ///< [s] of begin()
  Matrix3X<Scalar> forces_;      ///< [N]
  ForceReport report_;
  bool is_in_flight_ = false;
  long num_recomputed_ = 0;
  TaskGroup task_{TaskGroup::Place::kApart};
};

extern template class DeferredForces<float>;
extern template class DeferredForces<double>;

}  // namespace weft::forces
