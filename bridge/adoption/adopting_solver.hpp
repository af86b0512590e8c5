#pragma once

// Tested by tests/bridge/adoption/adoption_test.cpp.

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <weft/bridge/adoption/adoption.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The one line of a program that exists: a solver that adopts every soft body of its world, those that are added later too, at the
/// start of the next step.
///
///   weft::bridge::AdoptingSolver solver;
///   btSoftRigidDynamicsWorld world(dispatcher, broadphase, constraints, configuration, &solver);
///
/// A body that cannot be adopted is stepped by Bullet, bit for bit, and adopted as soon as it can; one whose adoption or policy
/// ends with an exception is not tried again. One that is detached is adopted again,
/// unless the policy says otherwise.
class AdoptingSolver : public SoftBodySolver {
 public:
  explicit AdoptingSolver(AdoptionSettings settings = {}) : settings_(std::move(settings)) {}

  /// Which bodies, and how: settings for a body, or nothing for one that stays Bullet's. Asked in each step for bodies
  /// without laws. Empty: all, with the settings of the constructor.
  using Policy = std::function<std::optional<AdoptionSettings>(const btSoftBody&)>;
  void set_policy(Policy policy) { policy_ = std::move(policy); }
  /// Called when a body is adopted and when one is refused for the first time, before the step. It must not throw.
  void set_on_adoption(std::function<void(btSoftBody&, const AdoptionReport&)> callback) {
    on_adoption_ = std::move(callback);
  }

  void optimize(btAlignedObjectArray<btSoftBody*>& bodies, bool force_update = false) override;

 private:
  struct Refused {
    btSoftBody* body;  ///< only compared
    bool is_final;
  };
  void adopt_one(btSoftBody& body);

  AdoptionSettings settings_;
  Policy policy_;
  std::function<void(btSoftBody&, const AdoptionReport&)> on_adoption_;
  std::vector<Refused> refused_;  ///< among the bodies of the last step
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
