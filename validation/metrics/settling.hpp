#pragma once

#include <optional>
#include <span>
#include <vector>

#include <weft/core/types.hpp>

namespace weft::validation {

/// When a cloth counts as at rest.
struct SettlingRule {
  double threshold = 1e-6;  ///< kinetic energy per mass below which it is at rest [m^2/s^2], > 0
  double hold = 0.5;        ///< how long it must stay below [s], >= 0
};

struct Settling {
  /// First sample after which the values stay below the threshold for the hold time [s]. None: it
  /// does not settle, or the series ends before the hold time is over.
  std::optional<double> time;
  bool stays_settled = false;  ///< below the threshold from then on to the end of the series
  /// Largest kinetic energy per mass in the last hold time of the series [m^2/s^2]; NaN if one of
  /// them is not finite.
  double residual = 0.0;
};

/// Settling time of a series. A value that is not finite is not at rest.
/// Shapes   times [s] strictly increasing, specific_kinetic_energies [m^2/s^2]; as many, >= 1
/// Errors   InvalidArgument for series or a rule out of their domain
[[nodiscard]] Settling settling(std::span<const double> times,
                                std::span<const double> specific_kinetic_energies,
                                const SettlingRule& rule = {});

/// Force that is left at rest, as a multiple of a node's weight: max |F_i| / (m_i g) over the nodes
/// that are free to move [-]. NaN if a force is not finite; 0 if every node is pinned.
/// Shapes   forces 3 x n [N], masses n [kg] > 0, pinned sorted node indices, gravity [m/s^2] > 0
/// Errors   InvalidArgument for shapes that do not fit and values out of their domain
[[nodiscard]] double force_residual(ConstMatrix3XRef<double> forces, const VectorX<double>& masses,
                                    const std::vector<int>& pinned, double gravity);

}  // namespace weft::validation
