#include <weft/bridge/implicit/substeps/substep_count.hpp>

#include <algorithm>
#include <cmath>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// How far a shape may approach a node in one substep, as a share of its smallest half extent [-].
constexpr btScalar kApproachShare = btScalar(0.2);
/// Likewise: how far springs may push it back in one substep.
constexpr btScalar kPushShare = btScalar(0.05);
/// Likewise: how far pins may pull the cloth that it presses.
constexpr btScalar kPullShare = btScalar(0.02);
/// An impact moves a body by more than this share of its size in a step, beside kLively.
constexpr btScalar kImpactShare = btScalar(0.01);
/// So many explicit substeps are done in the place of one implicit one, which costs as much as eleven to fifteen: twice the cost, for
/// an error that is a tenth or less.
constexpr btScalar kExplicitPerImplicit = 32;
/// The mean of cos^4 over the directions of a plane [-].
constexpr double kMeanStiffness = 3.0 / 8;

}  // namespace

btScalar wave_speed(const fast::SpringNetwork& network, const VectorX<double>& masses) {
  const double springs = (network.stiffness.array() * network.rest_lengths.array().square()).sum();
  const double mass = masses.sum();
  return mass > 0 ? static_cast<btScalar>(std::sqrt(kMeanStiffness * springs / mass)) : btScalar(0);
}

void SubstepCount::include(const RigidEncounter& encounter) {
  is_any_ = true;
  const auto& [size, approach, closing, pushed, fall, inverse_mass, pulled] = encounter;
  most_ = std::max({most_, approach / (kApproachShare * size),
                    (pushed - 2 * fall) / (kPushShare * size), pulled / (kPullShare * size)});
  // Two masses that stick together share their momentum.
  const btScalar mass_share = mass_ * inverse_mass / (1 + mass_ * inverse_mass);
  const btScalar least = kImpactShare * size;
  const bool is_impact = closing * mass_share > fall + least || pushed > kLively * fall + least;
  if (is_impact) most_ = std::max(most_, wave_distance_ / size);
}

SubstepPlan plan_substeps(int num_implicit, int last_num_implicit, btScalar num_explicit) {
  const auto most =
      kExplicitPerImplicit * static_cast<btScalar>(std::max(num_implicit, last_num_implicit));
  if (num_explicit > most) return {num_implicit, false, num_implicit};
  return {static_cast<int>(std::ceil(num_explicit)), true, num_implicit};
}

int SubstepCount::count(int last) const {
  const btScalar most = is_any_ ? std::max(most_, static_cast<btScalar>(last) / 2) : most_;
  return static_cast<int>(std::ceil(std::min(most, static_cast<btScalar>(kMost))));
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
