#pragma once

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace weft::contract {

/// What a check found: a value against the bound it must not exceed. Checks return this instead of
/// asserting, so that the sabotage tests can demand that a wrong law fails them.
struct Measurement {
  double measured = 0.0;
  double allowed = 0.0;
  std::string what;  ///< the quantity, for the failure message

  /// A measured value that is not a number does not hold.
  [[nodiscard]] bool holds() const { return measured <= allowed; }
};

/// The one with the larger ratio of measured to allowed; a failure wins over everything.
[[nodiscard]] Measurement worse(const Measurement& a, const Measurement& b);

[[nodiscard]] testing::AssertionResult holds(const Measurement& measurement);

/// n eps scale: what num_terms terms of size scale can be off by rounding. The few operations
/// behind a term partly cancel, so that the laws here measure at most 0.3 of it.
template <class Scalar>
[[nodiscard]] double roundoff(Eigen::Index num_terms, double scale) {
  const double epsilon = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
  return static_cast<double>(num_terms) * epsilon * scale;
}

/// Largest distance of a fitted order of convergence from its theory [-]: with the steps used here
/// the next term of the series changes the slope by less than 1e-3; 0.1 leaves room for the
/// round-off at the finest step and still tells 1 from 2 and 3 from 4.
inline constexpr double kOrderMargin = 0.1;

/// Fits error ~ step^order over a ladder of steps and measures |fit - order|. floors[i] is the
/// round-off of errors[i]: errors that do not exceed it take no part in the fit. Where none does,
/// the difference formula was exact (a linear law) and the largest error over floor is measured
/// instead; where only one does, that one fails.
[[nodiscard]] Measurement order_of_convergence(const std::string& what, double order,
                                               const std::vector<double>& steps,
                                               const std::vector<double>& errors,
                                               const std::vector<double>& floors);

}  // namespace weft::contract
