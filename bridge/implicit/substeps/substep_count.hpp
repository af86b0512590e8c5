#pragma once

// Tested by tests/bridge/implicit/substeps/substep_count_test.cpp, tests/bridge/implicit/fast_body_impact_test.cpp.

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/types.hpp>
#include <weft/fast_solver/network/spring_network.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The speed of longitudinal waves in a sheet of these springs, sqrt(C / area density) [m/s]. Springs in all directions of a
/// plane alike resist strain along one of them with C = 3/8 of the sum of k l^2 over the area, since the mean of cos^4 is 3/8.
/// 0 without mass or springs. masses: of the nodes [kg].
[[nodiscard]] btScalar wave_speed(const fast::SpringNetwork& network,
                                  const VectorX<double>& masses);

/// A dynamic body and a node that it meets in a step.
struct RigidEncounter {
  btScalar size;          ///< smallest half extent of the body [m]
  btScalar approach;      ///< how far its surface has come behind the node in the step [m]
  btScalar closing;       ///< how far it comes towards the node in RelativeMotion [m]
  btScalar pushed;        ///< how far the cloth has moved it in the last step [m]
  btScalar fall;          ///< how far gravity moves it in a step, g h^2 [m]
  btScalar inverse_mass;  ///< of the body [1/kg]
  btScalar pulled = 0;    ///< how far pins leave the node, if something is behind it: PinPull [m]
};

/// Into how many substeps a step is divided. The surface of a body that comes far would turn away from the nodes that it
/// meets. And in an impact that changes the body's velocity, waves carry energy away from where the body pushes: a step in
/// which they leave that place and come back gives too much of it back to the body.
class SubstepCount {
 public:
  /// wave_distance: how far stretching waves come in the step [m]. mass: of the cloth [kg].
  SubstepCount(btScalar wave_distance, btScalar mass)
      : wave_distance_(wave_distance), mass_(mass) {}
  void include(const RigidEncounter& encounter);
  /// A dynamic body is near: what short steps have begun goes on, with half as many in each step. Waves throw nodes about that have
  /// been hit; to expect them at the end of a long step where they would fly puts them into the body.
  void include_nearby_body() { is_any_ = true; }
  /// last: of the step before.
  [[nodiscard]] int count(int last) const;

  static constexpr int kMost = 56;
  /// The change of a body's velocity from which on cloth throws it back, over what gravity does in a step [-]. What lies on
  /// cloth has 1.
  static constexpr btScalar kLively = btScalar(2.5);

 private:
  btScalar wave_distance_;
  btScalar mass_;
  btScalar most_ = 1;
  bool is_any_ = false;
};

/// The substeps of all bodies that meet the same dynamic bodies.
struct SubstepPlan {
  int count = 1;
  bool is_explicit = false;
  int num_implicit = 1;  ///< the largest SubstepCount of a body
};

/// Explicit substeps, if so many as are stable do not cost too much. A wave that has not come farther than from node to node is no
/// error of theirs; implicit ones accelerate at once, and without giving it back, all that a wave would reach in a substep.
/// last_num_implicit: of the step before, because an impact that is resolved goes on in the next step. num_explicit: that are stable.
[[nodiscard]] SubstepPlan plan_substeps(int num_implicit, int last_num_implicit,
                                        btScalar num_explicit);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
