#include "tests/contract/sabotage.hpp"

#include <atomic>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <weft/core/parallel/threads.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::contract {
namespace {

using forces::ForceLaw;
using forces::State;

constexpr double kSmall = 1e-3;  ///< relative size of a fault that must still be found [-]

template <class Scalar>
class FaultyLaw final : public ForceLaw<Scalar> {
 public:
  FaultyLaw(std::unique_ptr<ForceLaw<Scalar>> law, Fault fault, const ClothMesh& mesh)
      : law_(std::move(law)), fault_(fault) {
    if (mesh.num_edges() == 0) return;
    for (const EdgeSet& set : mesh.edge_sets) {
      if (set.edges.cols() == 0) continue;
      first_edge_ = set.edges.col(0);
      return;
    }
  }

  const forces::LawInfo& info() const noexcept override { return law_->info(); }
  Eigen::Index scratch_columns() const override { return law_->scratch_columns(); }

  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const override {
    if (fault_ == Fault::kOverwrites) forces.setConstant(Scalar(0));
    Matrix3X<Scalar> right = Matrix3X<Scalar>::Constant(3, forces.cols(), Scalar(0));
    law_->add_forces(state, scratch, right);
    if (fault_ == Fault::kForceSign || fault_ == Fault::kDampingSign) right = -right;
    if (fault_ == Fault::kFloatConstant && std::is_same_v<Scalar, float>) {
      right *= Scalar(1 + kSmall);
    }
    add_pair_fault(state, right);
    add_node_fault(state, right);
    forces += right;
  }

  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch,
                             Matrix3XRef<Scalar> product) const override {
    law_->add_stiffness_product(state, displacements, scratch, product);
    if (fault_ == Fault::kStiffnessScale) {
      law_->add_stiffness_product(state, Matrix3X<Scalar>(Scalar(kSmall) * displacements), scratch,
                                  product);
    }
    if (fault_ == Fault::kStiffnessUnsymmetric) {
      product.row(0) += Scalar(kSmall) * displacements.row(1);
    }
  }

  void add_damping_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> velocity_changes,
                           Matrix3XRef<Scalar> scratch,
                           Matrix3XRef<Scalar> product) const override {
    law_->add_damping_product(state, velocity_changes, scratch, product);
    if (fault_ == Fault::kDampingScale) {
      law_->add_damping_product(state, Matrix3X<Scalar>(Scalar(kSmall) * velocity_changes), scratch,
                                product);
    }
  }

  Scalar potential_energy(const State<Scalar>& state) const override {
    const Scalar energy = law_->potential_energy(state);
    if (fault_ == Fault::kEnergyScale) return Scalar(1 + kSmall) * energy;
    if (fault_ == Fault::kEnergyClaimed) return energy + Scalar(kSmall);
    return energy;
  }

  Scalar non_conservative_power(const State<Scalar>& state) const override {
    const Scalar power = law_->non_conservative_power(state);
    const bool flipped = fault_ == Fault::kPowerSign || fault_ == Fault::kDampingSign;
    return flipped ? Scalar(-power) : power;
  }

  void advance_velocities(const State<Scalar>& state, Scalar time_step,
                          Matrix3XRef<Scalar> velocities) const override {
    if (fault_ == Fault::kEulerDecay) {
      Matrix3X<Scalar> scratch(3, scratch_columns());
      Matrix3X<Scalar> force = Matrix3X<Scalar>::Constant(3, velocities.cols(), Scalar(0));
      law_->add_forces(state, scratch, force);
      for (Eigen::Index i = 0; i < force.cols(); ++i) {
        velocities.col(i) += (time_step / state.masses[i]) * force.col(i);
      }
      return;
    }
    law_->advance_velocities(state, time_step, velocities);
    if (fault_ == Fault::kChangesVelocities) velocities *= Scalar(1 - kSmall);
  }

  void redistribute_forces(const State<Scalar>& state, Matrix3XRef<Scalar> forces) const override {
    const Matrix3X<Scalar> given = forces;
    law_->redistribute_forces(state, forces);
    add_inertia_fault(given, forces);
  }

  Scalar added_kinetic_energy(const State<Scalar>& state) const override {
    const Scalar energy = law_->added_kinetic_energy(state);
    return fault_ == Fault::kInertiaEnergy ? Scalar(1 + kSmall) * energy : energy;
  }

 private:
  void add_inertia_fault(const Matrix3X<Scalar>& given, Matrix3XRef<Scalar> forces) const {
    const Scalar small(kSmall);
    switch (fault_) {
      case Fault::kInertiaOfAll:
        forces *= Scalar(1) - small;
        break;
      case Fault::kInertiaOverPins:
        forces.col(0) *= Scalar(1) - small;
        break;
      case Fault::kInertiaSquare:
        forces(1, 2) += small * given(0, 3) * given(0, 3);
        break;
      case Fault::kInertiaTurned:
        forces.row(0) += small * given.row(1);
        break;
      case Fault::kInertiaReversed:
        forces = -forces;
        break;
      case Fault::kInertiaHiddenState:
        forces(1, 0) += small * Scalar(static_cast<double>(++calls_));
        break;
      case Fault::kInertiaFloat:
        if (std::is_same_v<Scalar, float>) forces.row(2) *= Scalar(1) - small;
        break;
      default:
        break;
    }
  }

  void add_pair_fault(const State<Scalar>& state, Matrix3X<Scalar>& force) const {
    const Eigen::Index i = first_edge_[0];
    const Eigen::Index j = first_edge_[1];
    const Vector3<Scalar> along = state.positions.col(j) - state.positions.col(i);
    const Vector3<Scalar> oblique(Scalar(1), Scalar(-2), Scalar(2));
    Vector3<Scalar> part = Vector3<Scalar>::Constant(Scalar(0));
    if (fault_ == Fault::kForceWithoutEnergy || fault_ == Fault::kFirstEdgeFavoured ||
        fault_ == Fault::kPrestress) {
      part = Scalar(kSmall) * along;
    }
    if (fault_ == Fault::kNetTorque) part = Scalar(kSmall) * along.cross(oblique);
    if (fault_ == Fault::kFixedDirection) part = Scalar(kSmall) * oblique;
    force.col(i) += part;
    force.col(j) -= part;
  }

  void add_node_fault(const State<Scalar>& state, Matrix3X<Scalar>& force) const {
    const Scalar small(kSmall);
    switch (fault_) {
      case Fault::kNetForce:
      case Fault::kFirstNodeFavoured:
      case Fault::kForceWithoutEdges:
        force(1, 0) += small;
        break;
      case Fault::kDrag:
        force -= small * state.velocities;
        break;
      case Fault::kHiddenState:
        force(1, 0) += small * Scalar(static_cast<double>(++calls_));
        break;
      case Fault::kThreadDependent:
        force(1, 0) += small * Scalar(num_threads());
        break;
      case Fault::kNotFinite:
        force(1, 0) += Scalar(std::numeric_limits<double>::quiet_NaN());
        break;
      default:
        break;
    }
  }

  std::unique_ptr<ForceLaw<Scalar>> law_;
  Fault fault_;
  Eigen::Vector2i first_edge_{0, 1};
  mutable std::atomic<int> calls_{0};
};

template <class Scalar>
Subject::Factory<Scalar> faulty(const Subject& right, Fault fault) {
  return [=](const ClothMesh& mesh) {
    return std::make_unique<FaultyLaw<Scalar>>(right.make<Scalar>(mesh), fault, mesh);
  };
}

}  // namespace

Subject sabotaged(const std::string& law, Fault fault) {
  const Subject right =
      registered_subject(law, typical_specification(*forces::find_law(law), true));
  return {.name = law,
          .traits = right.traits,
          .make_float = faulty<float>(right, fault),
          .make_double = faulty<double>(right, fault),
          .make_dual = faulty<Dual>(right, fault)};
}

}  // namespace weft::contract
