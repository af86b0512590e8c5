#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <string>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// Largest stable step of a cloth with its stiffness scaled and with an added inertia.
struct StabilityPoint {
  double stiffness_factor = 1.0;  ///< of every law that stores energy [-]
  double beta = 0.0;              ///< acceleration_damping [-]
  double predicted = 0.0;         ///< by the spectrum at the rest shape [s]
  double measured = 0.0;          ///< by trying, within kStabilityResolution [s]
};

/// Width of the bracket in which the search ends, largest over smallest step, minus 1 [-].
inline constexpr double kStabilityResolution = 0.01;

struct StabilityMap {
  std::string cloth;
  std::vector<StabilityPoint> points;  ///< all stiffness factors for the first beta, then the next
};

/// Runs modified Euler around the rest shape of each cloth under its internal laws (what pulls from
/// outside, gravity or wind, does not set the stable step), without colliders, for stiffness times
/// 1/4, 1/2, 1, 2, 4 and beta = 0, 0.5, 1, 3. A beta of the scene's own is replaced.
/// Throws InvalidArgument for a cloth without a law that stores energy.
[[nodiscard]] std::vector<StabilityMap> map_stability(const scenes::Scene& scene);

/// How far the prediction is from what was tried, at the worst point of a map.
[[nodiscard]] CheckResult stability_check(const StabilityMap& map);

/// Plot and table of a map.
[[nodiscard]] Section stability_section(const StabilityMap& map);

}  // namespace weft::validation
