#pragma once

// Tested by tests/bridge/cloth_test.cpp.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/bridge/step_error.hpp>
#include <weft/custom_forces/law_info.hpp>
#include <weft/custom_forces/set_up_warnings.hpp>
#include <weft/custom_forces/typed_laws.hpp>

class btCollisionWorld;

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

struct BodyLife;

struct ClothState {
  enum class Status {
    kGone,         ///< the body has been deleted, or the handle never had one
    kWithoutLaws,  ///< the body is Bullet's: detached, or its solver has been deleted
    kAwake,
    kAsleep,     ///< at rest, and not stepped until something disturbs it
    kSuspended,  ///< SoftBodySolver::set_suspended()
    kBlownUp,
  };
  Status status = Status::kGone;
  StepError step_error = {};                         ///< of the last step; implicit springs only
  std::optional<BodyBlowUp> blow_up = std::nullopt;  ///< node and reason, if kBlownUp
};

/// "gone", "without laws", "awake", "asleep", "suspended", "blown up".
[[nodiscard]] std::string_view name_of(ClothState::Status status);

/// A contact of a node that bore anything in the last step.
struct ClothContactPoint {
  int node = 0;
  const btCollisionObject* object = nullptr;  ///< it may have been deleted since the step
  btVector3 point{0, 0, 0};    ///< of the object's surface, the margin below the node [m]
  btVector3 normal{0, 0, 0};   ///< out of the object
  btVector3 impulse{0, 0, 0};  ///< of the object on the node, friction included [N s]
  bool is_sticking = false;    ///< if not, it slides
};

/// A handle of a body that a SoftBodySolver steps, to be passed by value. It is not the body's owner, and it may outlive both
/// body and solver: then it answers so, and changes nothing.
///
///   weft::bridge::Cloth cloth = solver.cloth(body);
///   cloth.set(weft::laws::tension({.stiffness = 2000.0}));
///
/// Threads  the thread that steps the world, between steps.
class Cloth {
 public:
  Cloth() = default;

  /// The body, or nullptr once it has been deleted.
  [[nodiscard]] btSoftBody* body() const;
  [[nodiscard]] ClothState state() const;
  /// The laws as they were given, in order. Empty for a body without laws, or that was attached with a LawSet.
  [[nodiscard]] std::vector<forces::LawSpecification> laws() const;

  /// Lists what will most likely not do what was meant: springs that are too stiff for the step, colliders that pass between nodes, gravity that
  /// acts twice, and the like (docs/warnings.md). time_step: that of the world's steps [s], > 0. Looks at the world as it is
  /// now, and takes some milliseconds. Empty for a body without laws, or that was attached with a LawSet.
  [[nodiscard]] std::vector<forces::SetUpWarning> warnings(const btCollisionWorld& world,
                                                           double time_step) const;

  /// Gives the body this law in place of those with the same name and sets, or in addition. A law without sets takes the place of
  /// all with its name. It acts from the next step on, which costs a factorisation. Returns nothing if that was done, or why not: the body
  /// is gone, has no laws, was attached with a LawSet, has torn, or has blown up. Throws InvalidArgument for a law that the registry or the body's mesh refuses; then
  /// nothing has changed.
  std::optional<std::string> set(const forces::LawSpecification& law);
  /// Takes away all laws with this name, with refusals as set().
  std::optional<std::string> remove(std::string_view law);

  /// The contacts with rigid objects and links, in ascending order of nodes; those of one node in the order in which the
  /// broadphase named their objects. After a step that was divided they are those of its last substep.
  [[nodiscard]] std::vector<ClothContactPoint> contacts() const;
  /// Called in each step after which contacts() is not empty, when the step's soft bodies are done, by the thread that steps the world. It may use
  /// solver and world, and must not throw: that ends the program. Empty: nobody is told. False if the body is gone or without laws.
  bool on_contact(std::function<void(const std::vector<ClothContactPoint>&)> callback);
  /// Called once, as SoftBodySolver::set_on_blow_up(), and before that.
  bool on_blow_up(std::function<void(const BodyBlowUp&)> callback);

 private:
  friend class SoftBodySolver;
  Cloth(SoftBodySolver& solver, btSoftBody& body, std::shared_ptr<BodyLife> life)
      : solver_(&solver), body_(&body), life_(std::move(life)) {}
  /// Whether the body is there and its laws are the solver's.
  [[nodiscard]] bool has_laws() const;
  std::optional<std::string> replace(const std::vector<forces::LawSpecification>& laws);

  SoftBodySolver* solver_ = nullptr;
  btSoftBody* body_ = nullptr;
  std::shared_ptr<BodyLife> life_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
