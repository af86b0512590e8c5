#pragma once

#include <optional>
#include <span>

namespace weft::validation {

/// Order p of errors that behave as C h^p: least-squares slope of ln error over ln step size.
/// None if an error is not positive and finite: a slope through round-off or NaN is no order.
/// Shapes   step_sizes > 0 (any unit), errors of the same number >= 2
/// Errors   InvalidArgument for step sizes out of their domain or all equal
[[nodiscard]] std::optional<double> observed_order(std::span<const double> step_sizes,
                                                   std::span<const double> errors);

/// One result on three levels, each ratio times finer than the one before.
struct RefinementLevels {
  double fine = 0.0;    ///< f1, step h
  double medium = 0.0;  ///< f2, step r h
  double coarse = 0.0;  ///< f3, step r^2 h
  double ratio = 2.0;   ///< r [-], > 1
};

/// How the results of three levels behave, by R = (f2 - f1) / (f3 - f2).
enum class RefinementKind {
  kMonotone,     ///< 0 < R < 1: order and extrapolation mean something
  kOscillatory,  ///< R < 0: only the range means something
  kDiverging,    ///< R >= 1: refinement does not make the differences smaller
  kUnresolved,   ///< f2 = f1 or f3 = f2: the differences are gone, an order cannot be seen
  kNotFinite,    ///< one of the results is NaN or infinite
};

/// Richardson extrapolation and grid convergence index (Roache; ASME V&V 20).
struct RefinementStudy {
  RefinementKind kind = RefinementKind::kNotFinite;
  double lowest = 0.0;   ///< smallest of the three results; NaN if not finite
  double highest = 0.0;  ///< largest of the three results; NaN if not finite
  // Set for kMonotone only:
  std::optional<double> order;         ///< p = ln((f3 - f2) / (f2 - f1)) / ln r [-]
  std::optional<double> extrapolated;  ///< f* = f1 + (f1 - f2) / (r^p - 1)
  std::optional<double> uncertainty;   ///< Fs |f1 - f2| / (r^p - 1), Fs = 1.25, in the unit of f
  // Set for kMonotone and f1, f2 not 0:
  std::optional<double> gci_fine;    ///< uncertainty / |f1| [-]
  std::optional<double> gci_coarse;  ///< Fs |f2 - f3| / (r^p - 1) / |f2| [-]
  /// gci_coarse / (r^p gci_fine) [-]; 0.95 to 1.05 in the asymptotic range. With p observed from
  /// the same three levels it equals |f1 / f2|: a weak test, so compare the order with the method's
  /// own as well.
  std::optional<double> asymptotic_ratio;
};

/// Throws InvalidArgument unless ratio > 1.
[[nodiscard]] RefinementStudy study_refinement(const RefinementLevels& levels);

/// Order from the norms of the differences of successive levels, |x_h - x_rh| and |x_rh - x_rrh|:
/// for shapes, where no single number converges [-]. None if a norm is not positive and finite.
/// Throws InvalidArgument unless ratio > 1.
[[nodiscard]] std::optional<double> order_of_differences(double fine_difference,
                                                         double coarse_difference, double ratio);

/// Orders between which a method converges: velocity Verlet is of order 2 where motion is smooth, of order 1 where bodies touch.
struct MethodOrder {
  double lowest = 1.0;   ///< [-], > 0
  double highest = 1.0;  ///< [-], >= lowest
};

/// What the differences of three levels of a shape tell of the finest one.
struct NormStudy {
  std::optional<double> order;  ///< observed [-]
  bool is_confirmed = false;    ///< the observed order is one of the method's, within 0.5
  /// Uncertainty of the finest level, in the unit of the differences: Fs |x_h - x_rh| / (r^p - 1). With a confirmed order Fs = 1.25
  /// and p the lesser of the observed and the method's lowest; else Fs = 3 and p the lowest. NaN if a difference is not finite.
  double uncertainty = 0.0;
};

/// Throws InvalidArgument unless ratio > 1 and the method's orders are in their domain.
[[nodiscard]] NormStudy study_norms(double fine_difference, double coarse_difference, double ratio,
                                    const MethodOrder& method);

/// Uncertainty of f1 from two levels and the order of the method: Fs |f1 - f2| / (r^p - 1), Fs = 3,
/// in the unit of f. NaN if a result is not finite. Throws InvalidArgument unless ratio > 1 and
/// order > 0.
[[nodiscard]] double two_level_uncertainty(double fine, double medium, double ratio, double order);

}  // namespace weft::validation
