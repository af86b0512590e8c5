#include <weft/validation/metrics/series/convergence.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/series/line_fit.hpp>

namespace weft::validation {
namespace {

constexpr double kThreeLevelSafety = 1.25;  ///< Roache's Fs with an observed order
constexpr double kTwoLevelSafety = 3.0;     ///< Roache's Fs with an assumed order

void check_ratio(double ratio) {
  if (!std::isfinite(ratio) || ratio <= 1) {
    throw InvalidArgument(fmt::format("convergence: ratio = {} [-], expected > 1", ratio));
  }
}

void add_extrapolation(const RefinementLevels& levels, RefinementStudy& study) {
  const auto& [fine, medium, coarse, ratio] = levels;
  const double factor = (coarse - medium) / (medium - fine);  // r^p
  study.order = std::log(factor) / std::log(ratio);
  study.extrapolated = fine + (fine - medium) / (factor - 1.0);
  study.uncertainty = kThreeLevelSafety * std::abs(fine - medium) / (factor - 1.0);
  if (fine == 0 || medium == 0) return;
  study.gci_fine = *study.uncertainty / std::abs(fine);
  study.gci_coarse =
      kThreeLevelSafety * std::abs(medium - coarse) / (factor - 1.0) / std::abs(medium);
  study.asymptotic_ratio = *study.gci_coarse / (factor * *study.gci_fine);
}

}  // namespace

std::optional<double> observed_order(std::span<const double> step_sizes,
                                     std::span<const double> errors) {
  if (step_sizes.size() != errors.size() || step_sizes.size() < 2) {
    throw InvalidArgument(
        fmt::format("convergence: step_sizes = {}, errors = {}, expected the same number >= 2",
                    step_sizes.size(), errors.size()));
  }
  std::vector<double> log_steps;
  std::vector<double> log_errors;
  for (std::size_t i = 0; i < step_sizes.size(); ++i) {
    if (!std::isfinite(step_sizes[i]) || step_sizes[i] <= 0) {
      throw InvalidArgument(
          fmt::format("convergence: step_size {} = {}, expected > 0 and finite", i, step_sizes[i]));
    }
    log_steps.push_back(std::log(step_sizes[i]));
    log_errors.push_back(errors[i] > 0 ? std::log(errors[i])
                                       : std::numeric_limits<double>::quiet_NaN());
  }
  const auto [smallest, largest] = std::minmax_element(step_sizes.begin(), step_sizes.end());
  if (*smallest == *largest) {
    throw InvalidArgument(
        fmt::format("convergence: step_sizes = {} all, expected different ones", *smallest));
  }
  const std::optional<LineFit> fit = fit_line(log_steps, log_errors);
  return fit ? std::optional<double>(fit->slope) : std::nullopt;
}

RefinementStudy study_refinement(const RefinementLevels& levels) {
  check_ratio(levels.ratio);
  RefinementStudy study;
  const auto [low, high] = std::minmax({levels.fine, levels.medium, levels.coarse});
  study.lowest = low;
  study.highest = high;
  const double fine_difference = levels.medium - levels.fine;
  const double coarse_difference = levels.coarse - levels.medium;
  if (!std::isfinite(fine_difference) || !std::isfinite(coarse_difference)) {
    study.lowest = study.highest = std::numeric_limits<double>::quiet_NaN();
    study.kind = RefinementKind::kNotFinite;
  } else if (fine_difference == 0 || coarse_difference == 0) {
    study.kind = RefinementKind::kUnresolved;
  } else if ((fine_difference < 0) != (coarse_difference < 0)) {
    study.kind = RefinementKind::kOscillatory;
  } else if (std::abs(fine_difference) >= std::abs(coarse_difference)) {
    study.kind = RefinementKind::kDiverging;
  } else {
    study.kind = RefinementKind::kMonotone;
    add_extrapolation(levels, study);
  }
  return study;
}

std::optional<double> order_of_differences(double fine_difference, double coarse_difference,
                                           double ratio) {
  check_ratio(ratio);
  const bool usable = std::isfinite(fine_difference) && std::isfinite(coarse_difference) &&
                      fine_difference > 0 && coarse_difference > 0;
  if (!usable) return std::nullopt;
  return std::log(coarse_difference / fine_difference) / std::log(ratio);
}

NormStudy study_norms(double fine_difference, double coarse_difference, double ratio,
                      const MethodOrder& method) {
  constexpr double kConfirmed = 0.5;
  if (!(method.highest >= method.lowest)) {
    throw InvalidArgument(fmt::format("convergence: highest order = {} [-], expected >= {}",
                                      method.highest, method.lowest));
  }
  NormStudy study;
  study.order = order_of_differences(fine_difference, coarse_difference, ratio);
  study.uncertainty = two_level_uncertainty(0.0, fine_difference, ratio, method.lowest);
  if (!std::isfinite(coarse_difference)) study.uncertainty = coarse_difference;
  study.is_confirmed = study.order && *study.order >= method.lowest - kConfirmed &&
                       *study.order <= method.highest + kConfirmed;
  if (study.is_confirmed) {
    const double believed = std::min(*study.order, method.lowest);
    study.uncertainty = kThreeLevelSafety * fine_difference / (std::pow(ratio, believed) - 1.0);
  }
  return study;
}

double two_level_uncertainty(double fine, double medium, double ratio, double order) {
  check_ratio(ratio);
  if (!std::isfinite(order) || order <= 0) {
    throw InvalidArgument(
        fmt::format("convergence: order = {} [-], expected > 0 and finite", order));
  }
  const double difference = std::abs(fine - medium);
  if (!std::isfinite(difference)) return std::numeric_limits<double>::quiet_NaN();
  return kTwoLevelSafety * difference / (std::pow(ratio, order) - 1.0);
}

}  // namespace weft::validation
