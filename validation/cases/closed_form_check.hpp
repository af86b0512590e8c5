#pragma once

#include <string>

#include <weft/validation/cases/case.hpp>

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

/// The metric under a deliberate mistake, which the check must not pass.
void add_sabotage(CheckResult& check, const std::string& mistake, double measured);

}  // namespace weft::validation
