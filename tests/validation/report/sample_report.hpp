#pragma once

#include <string>

#include <weft/validation/report/report.hpp>

namespace weft::tests {

/// Text that would run a script or break the data if any writer forgot to escape it.
inline const std::string kHostileText =
    "</script><script>window.hacked = true</script><!-- & \"quoted\" 'text'";

/// A report with every feature of the page: passed, failed, tight, loose and not gated rows, a
/// sabotage that nobody noticed, numbers that are not finite, pictures, plots on linear and
/// logarithmic axes, tables. Invented numbers.
[[nodiscard]] validation::Report sample_report();

/// The same without the failures: the report of a good day.
[[nodiscard]] validation::Report passing_report();

/// One that passes because what fails is stated: two checks of bullet_weft with one cause, beside the reference's, and a row of
/// pictures with both engines.
[[nodiscard]] validation::Report deviating_report();

}  // namespace weft::tests
