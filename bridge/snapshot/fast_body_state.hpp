#pragma once

// Tested by tests/bridge/snapshot_test.cpp, tests/engines/snapshot_test.cpp.

#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/implicit/fast_body.hpp>
#include <weft/bridge/snapshot/object_table.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/fast_solver/solver_state.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// A snapshot has this of a fast body: first what its solver was made of beside springs and masses, then what the next step
/// knows of the last ones. The second is restored into a body whose solver is made of the same.
class FastBodyState {
 public:
  /// Whether another solver of the same laws, pins and masses would do the same, to the bit.
  [[nodiscard]] static bool is_fresh(const FastBody& body) {
    return !body.history_.is_replaced &&
           (!body.solver_ || fast::SolverState::is_fresh(*body.solver_));
  }

  explicit FastBodyState(const FastBody& body);
  /// Throws Error for springs with other rest lengths than now.
  void serialize_structure(StateArchive& archive, const FastBody& body);
  /// Whether the rest can be restored into the body as it is.
  [[nodiscard]] bool fits(const FastBody& body) const;
  [[nodiscard]] bool has_new_rest_lengths() const { return num_new_rest_lengths_ > 0; }
  /// The nodes of the soft body are restored before.
  void serialize(StateArchive& archive, const ObjectTable& objects, const btSoftBody& nodes,
                 FastBody& body) const;

 private:
  void make_solver(FastBody& body) const;
  static void serialize_motion(StateArchive& archive, const btSoftBody& nodes, FastBody& body);

  bool has_solver_ = false;
  std::vector<char> free_nodes_;  ///< flags
  btScalar step_ = 0;             ///< [s] that stiffness is limited for
  int num_new_rest_lengths_ = 0;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
