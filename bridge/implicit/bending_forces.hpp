#pragma once

// Tested by tests/bridge/tearing_test.cpp, tests/bridge/implicit/explosion_test.cpp.

#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/custom_forces/law_set.hpp>
#include <weft/fast_solver/step_problem.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// How bending forces change within a step. Those of its start are among the forces that Bullet integrates, like those of all
/// laws that are not implicit; f(x) - f(q) is what an implicit step adds to them, so that it ends with f(x).
class BendingForces : public fast::StepForces<btScalar> {
 public:
  /// The bending laws of a set, which must live until the step ends. masses: n [kg].
  void set_laws(const forces::LawSet<btScalar>& laws, const VectorX<btScalar>& masses);
  [[nodiscard]] bool empty() const { return laws_.empty(); }
  /// starts: q, 3 x n [m].
  void begin_step(ConstMatrix3XRef<btScalar> starts);

  void add_forces(ConstMatrix3XRef<btScalar> positions,
                  Matrix3XRef<btScalar> forces) const override;
  [[nodiscard]] double energy(ConstMatrix3XRef<btScalar> positions) const override;

 private:
  void add_law_forces(ConstMatrix3XRef<btScalar> positions, Matrix3XRef<btScalar> forces) const;

  std::vector<const forces::ForceLaw<btScalar>*> laws_;
  VectorX<btScalar> masses_;
  Matrix3X<btScalar> no_velocities_;
  Matrix3X<btScalar> start_forces_;
  mutable Matrix3X<btScalar> scratch_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
