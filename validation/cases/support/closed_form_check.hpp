#pragma once

// Tested by tests/validation/theory_test.cpp.

#include <string>

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// What a check of the reference solver against a closed form says, without its numbers. The metric
/// is dimensionless.
struct ClosedForm {
  std::string claim;
  std::string metric;
  std::string formula;
  std::string source;
  Tolerance tolerance;
  std::string note;  ///< what to look at when it fails
  std::string engine = "reference";
};

[[nodiscard]] CheckResult judged(const CaseInfo& info, const ClosedForm& form, double measured);

/// |value / expected - 1|; not finite, so that no bound holds it, where expected is 0 or either is not a number.
[[nodiscard]] double relative_error(const ComparedValue& pair);

/// The same for the relative error of a number, which the check then shows beside the expected one.
[[nodiscard]] CheckResult judged(const CaseInfo& info, const ClosedForm& form,
                                 const ComparedValue& pair);

/// The metric under a deliberate mistake, which the check must not pass.
void add_sabotage(CheckResult& check, const std::string& mistake, double measured);

}  // namespace weft::validation
