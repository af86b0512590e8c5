#pragma once

#include <string>
#include <vector>

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// Throws InvalidArgument, one line with case, name, value, unit and what was expected, for a value
/// that the case has no parameter for, that is out of range or should be whole, and for an engine that
/// cannot run the case.
void check_values(const CaseInfo& info, const CaseOptions& options);

/// Whether one point is asked for in place of the case's table.
[[nodiscard]] inline bool asks_for_point(const CaseOptions& options) {
  return !options.values.empty();
}

/// Value of a parameter: as asked for, else its default. Throws InvalidArgument if it has neither.
[[nodiscard]] double value_of(const CaseInfo& info, const CaseOptions& options,
                              std::string_view name);
/// The same for a parameter that the case chooses itself if it is not asked for.
[[nodiscard]] double value_or(const CaseOptions& options, std::string_view name, double chosen);

/// One line per case (tier, id, summary) and one per parameter (name, unit, default, range).
[[nodiscard]] std::string describe(const CaseInfo& info);

}  // namespace weft::validation
