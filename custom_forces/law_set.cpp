#include <weft/custom_forces/law_set.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/core/trace.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::forces {
namespace {

double value_of(float x) {
  return x;
}
double value_of(double x) {
  return x;
}

/// x - x is 0 for every finite x and NaN otherwise. One sum over all numbers, for the vector unit.
template <class Matrix>
bool all_finite(const Matrix& matrix) {
  if (matrix.cols() > 1 && matrix.outerStride() != matrix.rows()) return false;  // not known yet
  using Scalar = typename Matrix::Scalar;
  const Eigen::Map<const VectorX<Scalar>> numbers(matrix.data(), matrix.size());
  return (numbers - numbers).sum() == Scalar(0);
}

template <class Scalar>
std::optional<int> first_non_finite_node(const State<Scalar>& state) {
  if (all_finite(state.positions) && all_finite(state.velocities) && all_finite(state.masses)) {
    return std::nullopt;
  }
  for (Eigen::Index node = 0; node < state.positions.cols(); ++node) {
    double sum = value_of(state.masses[node]);
    for (int axis = 0; axis < 3; ++axis) {
      sum += value_of(state.positions(axis, node)) + value_of(state.velocities(axis, node));
    }
    // A sum of finite doubles from float input cannot overflow; one from double input could, and
    // such a state is beyond use as well.
    if (sum - sum != 0.0) return static_cast<int>(node);
  }
  return std::nullopt;
}

template <class Scalar>
bool takes_part(const ForceLaw<Scalar>& law, typename LawSet<Scalar>::VelocityLaws velocity_laws) {
  using VelocityLaws = typename LawSet<Scalar>::VelocityLaws;
  if (velocity_laws == VelocityLaws::kAsForces) return true;
  const bool is_velocity_law = law.info().traits.level == LawTraits::Level::kVelocity;
  return is_velocity_law == (velocity_laws == VelocityLaws::kAlone);
}

template <class Scalar>
void check_shapes(const State<Scalar>& state, Eigen::Index result_columns,
                  Eigen::Index direction_columns) {
  const Eigen::Index n = state.positions.cols();
  if (state.velocities.cols() != n || state.masses.size() != n || result_columns != n ||
      direction_columns != n) {
    throw InvalidArgument("law set: positions 3 x " + std::to_string(n) + ", velocities 3 x " +
                          std::to_string(state.velocities.cols()) + ", masses " +
                          std::to_string(state.masses.size()) + ", result 3 x " +
                          std::to_string(result_columns) + ", direction 3 x " +
                          std::to_string(direction_columns) +
                          ", expected the same number of nodes");
  }
}

template <class Scalar>
void check_shapes(const State<Scalar>& state, Eigen::Index result_columns) {
  check_shapes(state, result_columns, state.positions.cols());
}

}  // namespace

template <class Scalar>
void LawSet<Scalar>::add(std::unique_ptr<ForceLaw<Scalar>> law) {
  if (!law) throw InvalidArgument("law set: law is null, expected a law");
  const Eigen::Index columns = std::max(scratch_.cols(), law->scratch_columns());
  scratch_.setZero(3, columns);
  laws_.push_back(std::move(law));
}

template <class Scalar>
ForceReport LawSet<Scalar>::add_forces(const State<Scalar>& state, VelocityLaws velocity_laws,
                                       Matrix3XRef<Scalar> forces) {
  check_shapes(state, forces.cols());
  ForceReport report{first_non_finite_node(state)};
  if (!report.ok()) return report;
  for (const auto& law : laws_) {
    if (!takes_part(*law, velocity_laws)) continue;
    const TraceScope trace(law->info().id);
    law->add_forces(state, scratch_, forces);
  }
  return report;
}

template <class Scalar>
bool LawSet<Scalar>::is_node_by_node() const {
  return std::all_of(laws_.begin(), laws_.end(), [](const auto& law) {
    const LawTraits& traits = law->info().traits;
    return traits.is_pointwise && traits.level != LawTraits::Level::kInertia &&
           law->scratch_columns() == 0;
  });
}

template <class Scalar>
void LawSet<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                           ConstMatrix3XRef<Scalar> displacements,
                                           Matrix3XRef<Scalar> product) {
  check_shapes(state, product.cols(), displacements.cols());
  for (const auto& law : laws_) {
    law->add_stiffness_product(state, displacements, scratch_, product);
  }
}

template <class Scalar>
void LawSet<Scalar>::add_damping_product(const State<Scalar>& state,
                                         ConstMatrix3XRef<Scalar> velocity_changes,
                                         Matrix3XRef<Scalar> product) {
  check_shapes(state, product.cols(), velocity_changes.cols());
  for (const auto& law : laws_) {
    law->add_damping_product(state, velocity_changes, scratch_, product);
  }
}

template <class Scalar>
void LawSet<Scalar>::advance_velocities(const State<Scalar>& state, Scalar time_step,
                                        Matrix3XRef<Scalar> velocities) const {
  check_shapes(state, velocities.cols());
  for (const auto& law : laws_) {
    if (law->info().traits.level == LawTraits::Level::kVelocity) {
      const TraceScope trace(law->info().id);
      law->advance_velocities(state, time_step, velocities);
    }
  }
}

template <class Scalar>
void LawSet<Scalar>::redistribute_forces(const State<Scalar>& state,
                                         Matrix3XRef<Scalar> forces) const {
  check_shapes(state, forces.cols());
  for (const auto& law : laws_) {
    if (law->info().traits.level == LawTraits::Level::kInertia) {
      law->redistribute_forces(state, forces);
    }
  }
}

template <class Scalar>
bool LawSet<Scalar>::has_level(LawTraits::Level level) const {
  return std::any_of(laws_.begin(), laws_.end(),
                     [&](const auto& law) { return law->info().traits.level == level; });
}

template <class Scalar>
Scalar LawSet<Scalar>::added_kinetic_energy(const State<Scalar>& state) const {
  check_shapes(state, state.positions.cols());
  Scalar energy(0);
  for (const auto& law : laws_) energy += law->added_kinetic_energy(state);
  return energy;
}

template <class Scalar>
Scalar LawSet<Scalar>::potential_energy(const State<Scalar>& state) const {
  check_shapes(state, state.positions.cols());
  Scalar energy(0);
  for (const auto& law : laws_) energy += law->potential_energy(state);
  return energy;
}

template <class Scalar>
Scalar LawSet<Scalar>::non_conservative_power(const State<Scalar>& state) const {
  check_shapes(state, state.positions.cols());
  Scalar power(0);
  for (const auto& law : laws_) power += law->non_conservative_power(state);
  return power;
}

template class LawSet<float>;
template class LawSet<double>;

}  // namespace weft::forces
