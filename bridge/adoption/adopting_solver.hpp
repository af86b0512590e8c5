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
///
/// A body that it has adopted is adopted anew when its springs cannot stand in for its links any more: when nodes, links or faces
/// have come or gone (appendLink, cutLink, refine), and when kLST of a material or the iterations have changed. One that gets clusters,
/// a pose to match or a timescale is Bullet's until it has none. Laws and callbacks that were set by its handle are lost then.
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
  /// The properties that the springs of an adopted body were made of.
  struct Source {
    int num_nodes = 0;
    int num_links = 0;
    int num_faces = 0;
    int iterations = 0;
    std::vector<btScalar> factors;  ///< kLST of each material

    [[nodiscard]] static Source of(const btSoftBody& body);
    bool operator==(const Source&) const = default;
  };
  struct Adopted {
    Cloth cloth;
    Source source;
  };
  struct Refused {
    btSoftBody* body;  ///< only compared
    bool is_final;
  };
  void adopt_one(btSoftBody& body);
  void give_back_changed();

  AdoptionSettings settings_;
  Policy policy_;
  std::function<void(btSoftBody&, const AdoptionReport&)> on_adoption_;
  std::vector<Adopted> adopted_;
  std::vector<Refused> refused_;  ///< among the bodies of the last step
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
