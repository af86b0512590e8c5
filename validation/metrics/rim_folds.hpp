#pragma once

#include <array>
#include <optional>

#include <weft/core/types.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::validation {

/// The mode numbers in which folds are looked for; 0 is the size and 1 an offset from the axis.
inline constexpr int kFirstFoldMode = 2;
inline constexpr int kLastFoldMode = 24;

/// How a rim is looked at.
struct RimSetup {
  Vector3<double> up{0, 1, 0};      ///< any length > 0 [-]
  Vector3<double> center{0, 0, 0};  ///< any point on the vertical axis [m]
  int num_angles = 720;             ///< samples of r(phi), >= 50 so that mode 24 is resolved
  /// What a maximum must rise above its surroundings to count as a fold [m], >= 0.
  double prominence = 0.002;
};

/// The rim of a draped cloth as a curve r(phi) around the vertical axis, and its folds.
/// A specimen with corners has modes of its own, whatever its folds: a flat square has mode 4.
/// Compare fold counts for round specimens, or with the spectrum of the flat specimen.
struct RimFolds {
  /// r(phi_k) [m], phi_k = 2 pi k / num_angles; the outermost crossing of the rim.
  VectorX<double> radii;
  double mean_radius = 0.0;  ///< [m]
  /// Amplitude [m] of cos(m phi - phase) in r(phi), m = kFirstFoldMode ... kLastFoldMode.
  std::array<double, kLastFoldMode - kFirstFoldMode + 1> amplitudes{};
  /// Mode of the largest amplitude: the fold count; the lowest one if several are equal.
  int dominant_mode = 0;
  int num_maxima = 0;  ///< maxima of r(phi) with the asked prominence
};

/// None if a position is not finite or the rim does not surround the axis.
/// The rim is made of the edges that belong to one triangle only.
/// Shapes   positions 3 x n [m], n as the mesh
/// Errors   InvalidArgument for a setup out of its domain, positions of another size, a mesh
/// without a rim
[[nodiscard]] std::optional<RimFolds> rim_folds(const ClothMesh& mesh,
                                                ConstMatrix3XRef<double> positions,
                                                const RimSetup& setup);

/// Number of maxima of a closed curve that rise at least prominence above the higher of the two
/// valleys that part them from higher ground, one to each side; the highest maximum rises from the
/// lowest valley. A plateau counts once, of two equally high maxima with a shallow valley between
/// them only one counts, a constant curve has none.
[[nodiscard]] int count_maxima(const VectorX<double>& closed_curve, double prominence);

}  // namespace weft::validation
