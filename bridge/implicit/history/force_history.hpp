#pragma once

// Tested by tests/bridge/implicit/fast_body_impact_test.cpp, tests/bridge/implicit/fast_body_test.cpp.

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/core/types.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Forces of springs in the last steps, for a method of second order with contact: that of Hilber, Hughes and Taylor (1977) in
/// the form that has positions instead of accelerations,
///
///   x' - x = h v,   v' - v = h (a + (w f(x') + known) / m) + contact / m
///
/// Contact and friction act with the whole step, at its end, so that a node that a surface stops is at rest there: what springs
/// did is known beforehand, what contact will do is not (as in Deuflhard, Krause and Ertel 2008).
class ForceHistory {
 public:
  /// w: share of the forces at the end of the step.
  static constexpr btScalar kShare = btScalar(0.288);
  /// Than the step before.
  static constexpr btScalar kLonger = btScalar(2.1);

  /// The next step is none of this method.
  void forget() { step_ = 0; }
  /// Whether the last step has left forces of so many nodes, and was not much shorter: forces that short steps have seen come
  /// and go tell nothing of a long one.
  [[nodiscard]] bool fits(Eigen::Index num_nodes, btScalar time_step) const {
    return kLonger * step_ >= time_step && last_.cols() == num_nodes;
  }
  /// Before the next step, of time_step [s]: what is known of the step before one of another length counts as that of now.
  void begin_step(btScalar time_step);
  /// The known force on a node [N].
  [[nodiscard]] Vector3<btScalar> known(Eigen::Index node) const;
  /// Room for the forces at the end of a step [N], of all nodes, each range of which is to be written to coming() and then added.
  void resize(Eigen::Index num_nodes, btScalar time_step);
  [[nodiscard]] auto coming(Eigen::Index first, Eigen::Index count) {
    return coming_.middleCols(first, count);
  }
  void add(Eigen::Index first, Eigen::Index count);

  /// For a body of so many nodes.
  void serialize(StateArchive& archive, Eigen::Index num_nodes);

 private:
  // With Newmark's beta and gamma for second order and damping of what is fast.
  static constexpr btScalar kAlpha = btScalar(-0.2);
  static constexpr btScalar kBeta = (1 - kAlpha) * (1 - kAlpha) / 4;
  static constexpr btScalar kGamma = btScalar(0.5) - kAlpha;

  btScalar step_ = 0;  ///< [s]; 0: nothing is known
  bool has_filtered_ = false;
  Matrix3X<btScalar> last_;             ///< f(x) [N]
  Matrix3X<btScalar> filtered_;         ///< (1 + alpha) f(x) - alpha f of the step before [N]
  Matrix3X<btScalar> filtered_before_;  ///< the same of the step before [N]
  Matrix3X<btScalar> coming_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
