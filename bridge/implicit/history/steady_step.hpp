#pragma once

// Tested by tests/bridge/implicit/history/steady_step_test.cpp.

#include <span>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Whether a body begins its step among the same things as the last one, to the bit: the length of the step, the body's own
/// settings, and boxes and balls that stand still. Beside anything else it does not.
class SteadyStep {
 public:
  /// So many solutions have to begin and end alike before the next one is taken for the same. One would do, because a step
  /// follows from how it begins; two guard against a part of the beginning that is compared nowhere.
  static constexpr int kFewest = 2;

  /// The contacts of the last step are kept, and taken from the list.
  void begin_step(std::vector<RigidContact>& contacts) {
    contacts_.swap(contacts);
    contacts.clear();
    is_any_ = is_any_ && is_noted_;
    is_noted_ = false;
  }
  /// To be called once in a step.
  [[nodiscard]] bool has_same_surroundings(const btSoftBody& body,
                                           std::span<const Collider> colliders, btScalar time_step);
  /// is_same: whether the step begins with the same state too. solver: none, or that of the last step, with whose contact states
  /// the next solution begins. True if steps before have shown how the step ends.
  [[nodiscard]] bool is_known(bool is_same, const fast::ImplicitSolver<btScalar>* solver);
  /// The state of the body, 3 x n each: positions at the start of this step, of the last one and at its end [m]; velocities at both starts,
  /// in the last prediction and solution [m/s].
  struct State {
    const Matrix3X<btScalar>& starts;
    const Matrix3X<btScalar>& last_starts;
    const Matrix3X<btScalar>& last_ends;
    const Matrix3X<btScalar>& velocities;
    const Matrix3X<btScalar>& last_velocities;
    const Matrix3X<btScalar>& last_predicted;
    const Matrix3X<btScalar>& last_solution;
  };
  void forget() { num_same_ = 0, is_any_ = false; }
  /// Gives the contacts of the last step back.
  void restore(std::vector<RigidContact>& contacts) { contacts.swap(contacts_); }

 private:
  struct Surface {
    const btCollisionObject* object;
    const btCollisionShape* shape;
    btTransform pose;
    btVector3 size;
    btScalar friction;
    bool has_response;

    [[nodiscard]] bool operator==(const Surface& other) const {
      return object == other.object && shape == other.shape && pose == other.pose &&
             size == other.size && friction == other.friction && has_response == other.has_response;
    }
  };
  struct Surroundings {
    btScalar time_step = 0;  ///< [s]
    btScalar margin = 0;     ///< [m]
    btScalar friction = 0;
    btScalar damping = 0;
    int collisions = 0;
    std::vector<Surface> surfaces;

    [[nodiscard]] bool operator==(const Surroundings& other) const = default;
  };

  bool is_any_ = false;    ///< last_ is of the last step, which may be repeated
  bool is_noted_ = false;  ///< last_ is of the present step
  int num_same_ = 0;
  Surroundings last_;
  Surroundings now_;  ///< kept for its memory
  std::vector<RigidContact> contacts_;
  std::vector<fast::ContactState> states_;  ///< with which the last solution began
};

/// Whether the step begins as the last one, which has ended where it began, and all nodes are free: to the bit.
[[nodiscard]] bool begins_as_last(const btSoftBody& body, const SteadyStep::State& state);

/// Ends a step where it began, with these velocities of the solution [m/s].
void stay(const Matrix3X<btScalar>& velocities, btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
