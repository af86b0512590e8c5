#pragma once

#include <memory>
#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/custom_forces/force_law.hpp>
#include <weft/custom_forces/law_info.hpp>
#include <weft/custom_forces/laws/elastic/hinge_torsion.hpp>
#include <weft/fast_solver/network/element_stiffness.hpp>
#include <weft/fast_solver/step_problem.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The bending laws of a body, which an implicit step solves for like its springs: they are not among the forces that Bullet
/// integrates.
class BendingForces : public fast::StepForces<btScalar> {
 public:
  BendingForces() = default;
  /// Those of the laws that resist bending. Throws as forces::make_law().
  BendingForces(const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws);
  [[nodiscard]] bool empty() const { return laws_.empty(); }
  /// n [kg]
  void set_masses(const VectorX<double>& masses);

  void add_forces(ConstMatrix3XRef<btScalar> positions,
                  Matrix3XRef<btScalar> forces) const override;
  [[nodiscard]] double energy(ConstMatrix3XRef<btScalar> positions) const override;
  /// Not where a law is not hinge_torsion: of others only the stiffness at the rest shape is known.
  [[nodiscard]] bool has_stiffness() const override { return hinges_.size() == laws_.size(); }
  [[nodiscard]] fast::ElementStiffness* stiffness(
      ConstMatrix3XRef<btScalar> positions) const override;

 private:
  using Hinges = forces::HingeTorsion<btScalar>;
  [[nodiscard]] forces::State<btScalar> state_at(ConstMatrix3XRef<btScalar> positions) const {
    return {positions, no_velocities_, masses_, 0.0};
  }
  void set_hinges(int num_nodes);

  std::vector<std::unique_ptr<forces::ForceLaw<btScalar>>> laws_;
  std::vector<const Hinges*> hinges_;  ///< of those
  VectorX<btScalar> masses_;
  Matrix3X<btScalar> no_velocities_;
  mutable Matrix3X<btScalar> scratch_;
  mutable fast::ElementStiffness stiffness_;
  mutable Hinges::Gradients gradients_;  ///< of one law
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
