#include <weft/bridge/implicit/stiffness_limit.hpp>

#include <algorithm>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

bool limit_stiffness(double time_step, const VectorX<double>& masses,
                     fast::SpringNetwork& network) {
  bool is_beyond = false;
  const auto limit = [&](double most, double& value) {
    if (value <= most) return;
    value = most;
    is_beyond = true;
  };
  for (Eigen::Index e = 0; e < network.edges.cols(); ++e) {
    const double mass = std::min(masses[network.edges(0, e)], masses[network.edges(1, e)]);
    const double most = kMostStiffness * mass / (time_step * time_step);
    limit(most, network.stiffness[e]);
    limit(most, network.compressed_stiffness[e]);
    limit(most * time_step, network.damping[e]);
  }
  return is_beyond;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
