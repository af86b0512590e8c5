#pragma once

// Tested by tests/bridge/implicit/fast_body_impact_test.cpp, tests/bridge/rigid/multibody_test.cpp.

#include <span>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/rigid/movable_object.hpp>
#include <weft/bridge/rigid/multibody_inertia.hpp>
#include <weft/bridge/rigid/rigid_motion.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

class ObjectTable;

/// Rigid bodies and links of multibodies that a cloth may push in a step: what its solver knows of them, and what they get of
/// the solution. Links of one multibody are solved for together, with the inertia that joints give them.
class CoupledBodies {
 public:
  void begin_step();
  /// pushed: MovableObject::inertia_owner() of those of all cloths, in order. If several may push one, each has a share of
  /// its inertia.
  void begin_solve(std::span<const void* const> pushed) {
    of_all_.assign(pushed.begin(), pushed.end());
  }
  /// The next solve names its bodies anew.
  void clear();
  /// The number of a body in the solver; one that is pushed for the first time in this solve gets the next number. is_again: from where the
  /// last solution has moved it to.
  [[nodiscard]] int number_of(const MovableObject& object, btDispatcher* dispatcher,
                              btScalar time_step, bool is_again);
  /// Once all have numbers: the inertia of links depends on which of them are pushed.
  void couple_links();
  [[nodiscard]] bool empty() const { return bodies_.empty(); }
  [[nodiscard]] std::span<const fast::RigidInertia<btScalar>> inertias() const { return inertias_; }
  /// The solution is expected to move a body by so much more [m].
  void add_to_guess(int number, const Vector3<btScalar>& displacement) {
    inertias_[static_cast<std::size_t>(number)].guess.template head<3>() += displacement;
  }
  [[nodiscard]] std::span<const fast::InertiaCoupling<btScalar>> couplings() const {
    return couplings_;
  }

  /// Keeps the displacements of a solution, after a solve.
  void read_displacements(const fast::ImplicitSolver<btScalar>& solver, btScalar time_step);
  /// The displacement of a body in the last solution; zero for others.
  [[nodiscard]] GeneralizedDisplacement displacement_of(const MovableObject& object) const;
  /// How far the same push would have moved it in a step of time_step [s], [m].
  [[nodiscard]] btScalar push_in(const MovableObject& object, btScalar time_step) const;
  /// Whether the last solution has borne about the weight of an object. time_step: of a step [s].
  [[nodiscard]] bool has_borne(const MovableObject& object, btScalar time_step) const;
  /// Whether bodies were pushed into others that had not held them in the last solution, or the other way round.
  [[nodiscard]] bool are_supports_wrong(btScalar time_step);

  /// Snapshots save what the next step reads of the last one.
  void serialize(StateArchive& archive, const ObjectTable& objects);

  [[nodiscard]] double kinetic_energy() const;
  /// That exchange_impulses() will give them [J].
  [[nodiscard]] double energy_to_come(btScalar time_step) const;
  /// The momentum of the motion that the solution has given to each.
  void exchange_impulses(btScalar time_step);
  /// That motion too: Bullet has moved them before, and would leave nodes inside of them until the next step. Not what touches
  /// something else, whose friction may hold it, and only what moves_freely(object).
  template <class MovesFreely>
  void move_at_once(btScalar time_step, const MovesFreely& moves_freely) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const bool touches = std::any_of(supports_.begin(), supports_.end(),
                                       [&](const Support& one) { return one.body == bodies_[b]; });
      if (touches || !moves_freely(bodies_[b])) continue;
      bridge::move_at_once(bodies_[b], velocities_before_[b], time_step);
    }
  }

 private:
  /// The links of one multibody that are pushed.
  struct PushedMultiBody {
    MultiBodyInertia inertia;
    std::vector<int> bodies;  ///< their numbers
    Eigen::MatrixXd
        of_links;  ///< 6 per link: MultiBodyInertia::inertia_of() times the cloth's share
  };
  [[nodiscard]] btScalar share_of(const MovableObject& object) const;
  /// The generalised impulse that a solution gives to a multibody.
  [[nodiscard]] VectorX<double> impulse_on(const PushedMultiBody& pushed, btScalar time_step) const;
  [[nodiscard]] const std::vector<Support>& supports_of(const MovableObject& object,
                                                        btDispatcher* dispatcher,
                                                        btScalar time_step);

  std::vector<MovableObject> bodies_;  ///< by their numbers
  std::vector<fast::RigidInertia<btScalar>> inertias_;
  std::vector<fast::InertiaCoupling<btScalar>> couplings_;
  std::vector<PushedMultiBody> multibodies_;
  std::vector<RigidVelocity> velocities_before_;
  std::vector<Support> supports_;  ///< of supported_
  std::vector<MovableObject> supported_;
  std::vector<MovableObject> last_held_;  ///< with a loaded support in the step before
  std::vector<const void*> of_all_;       ///< owners of inertia that any cloth pushes, in order
  std::vector<MovableObject> last_;       ///< in the last solution, and how far
  std::vector<GeneralizedDisplacement> last_displacements_;
  btScalar last_step_ = 0;  ///< [s] of it
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
