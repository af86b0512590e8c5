#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <weft/validation/motion/swing.hpp>

namespace weft::bench {

/// A sheet that swings from two corners.
struct SwingSheet {
  std::string name;
  int nodes;    ///< along an edge
  double mass;  ///< [kg]
};

inline constexpr double kSwingStep = 1.0 / 60;  // [s]
inline constexpr int kSwingSteps = 180;         // 3 s
inline constexpr double kSwingMiddle =
    1.0;  // [s] where one mean of kinetic energy ends and the next begins
inline constexpr double kSwingEnd = 3.0;  // [s]

[[nodiscard]] std::vector<SwingSheet> swing_sheets();
[[nodiscard]] std::vector<double> swing_stiffnesses();  ///< [N/m]

/// The stored figures of a right run.
struct SwingTruth {
  double first_energy = 0;  ///< mean kinetic energy to 1 s [J]
  double later_energy = 0;  ///< from 1 to 3 s [J]
  double turning_time = 0;  ///< [s]
  double largest_stretch = 0;
  double mean_stretch = 0;
  double residual =
      0;  ///< what the equations of its steps lack, RMS over nodes and steps, over m g [-]; exact: 0
};

/// The runs of one sheet and stiffness: the step of 1/60 s solved by the fast solver with very many iterations, and explicit integration in short steps.
struct SwingTruths {
  SwingTruth converged;
  std::optional<SwingTruth> exact;
  validation::Places sample;  ///< of the one that is right: sampled()

  /// Whether the step's equations hold, so that it is the step that is right and not what short steps would do.
  [[nodiscard]] bool has_converged() const { return converged.residual < kMostResidual; }
  [[nodiscard]] const SwingTruth& right() const {
    return has_converged() || !exact ? converged : *exact;
  }
  static constexpr double kMostResidual = 0.1;  ///< over m g [-]
};

/// 25 nodes spread over the sheet, ten times a second.
[[nodiscard]] validation::Places sampled(const validation::Places& places, int nodes);

/// Truths by "<sheet> <stiffness>", as swing_key() makes it. Throws Error naming the file if one of the two is not there or not as
/// write_swing_truths() writes it.
[[nodiscard]] std::string swing_key(const SwingSheet& sheet, double stiffness);
[[nodiscard]] SwingTruths read_swing_truths(const std::filesystem::path& folder,
                                            const std::string& key);
[[nodiscard]] std::filesystem::path swing_truth_file(const std::filesystem::path& folder,
                                                     const std::string& key);
void write_swing_truths(const std::filesystem::path& folder, const std::string& key,
                        const SwingTruths& truths);

}  // namespace weft::bench
