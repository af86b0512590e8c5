#include <weft/bridge/implicit/substeps/explicit_substeps.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// The share of the longest stable step that substeps take [-].
constexpr double kStableShare = 0.9;

}  // namespace

btScalar stable_step(const fast::SpringNetwork& network, const VectorX<double>& masses) {
  if ((network.damping.array() != 0).any() || network.edges.cols() == 0) return 0;
  VectorX<double> sums = VectorX<double>::Zero(masses.size());
  for (Eigen::Index e = 0; e < network.edges.cols(); ++e) {
    const double most = std::max(network.stiffness[e], network.compressed_stiffness[e]) +
                        std::abs(network.bending[e]);
    for (int end = 0; end < 2; ++end) sums[network.edges(end, e)] += 2 * most;
  }
  double square = 0;  // of the angular frequency
  for (Eigen::Index i = 0; i < masses.size(); ++i) {
    if (masses[i] > 0) square = std::max(square, sums[i] / masses[i]);
  }
  return square > 0 ? static_cast<btScalar>(kStableShare * 2 / std::sqrt(square)) : btScalar(0);
}

btScalar ExplicitSubsteps::count(btScalar time_step) const {
  return stable_step_ > 0 ? time_step / stable_step_ : std::numeric_limits<btScalar>::max();
}

void ExplicitSubsteps::forget() {
  stable_step_ = 0;
  solver_.reset();
}

void ExplicitSubsteps::begin(const Solver& whole_steps, const VectorX<double>& masses,
                             const std::vector<bool>& is_free, const std::vector<int>& pins) {
  if (!solver_ || pins_ != pins) {
    solver_ = std::make_unique<Solver>(fast::SpringNetwork{}, masses, is_free);
    pins_ = pins;
  }
  solver_->continue_contacts(whole_steps);
}

void ExplicitSubsteps::find_forces(Solver& whole_steps, const BendingForces& bending,
                                   const Matrix3X<btScalar>& starts, fast::WorkerTeam& team) {
  forces_.setZero(3, starts.cols());
  whole_steps.find_spring_forces(starts, forces_, team);
  if (!bending.empty()) bending.add_forces(starts, forces_);
  target_rounding_.resize(3, starts.cols());
}

void ExplicitSubsteps::set_targets(int begin, int count, btScalar time_step,
                                   const VectorX<double>& masses, const Matrix3X<btScalar>& starts,
                                   const Matrix3X<btScalar>& velocities,
                                   Matrix3X<btScalar>& targets) {
  for (int i = begin; i < begin + count; ++i) {
    const auto mass = static_cast<btScalar>(masses[i]);
    const btScalar per_mass = mass > 0 ? time_step / mass : btScalar(0);
    const Vector3<btScalar> displacement =
        time_step * (velocities.col(i) + per_mass * forces_.col(i));
    targets.col(i) = starts.col(i) + displacement;
    target_rounding_.col(i) = displacement - (targets.col(i) - starts.col(i));
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
