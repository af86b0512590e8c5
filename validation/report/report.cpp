#include <algorithm>

#include <weft/validation/report/report.hpp>

namespace weft::validation {

bool Report::passed() const {
  return std::all_of(checks.begin(), checks.end(), [](const CheckResult& check) {
    return check.verdict != Verdict::kFail && check.verdict != Verdict::kStale &&
           std::all_of(check.sabotages.begin(), check.sabotages.end(),
                       [](const SabotageResult& sabotage) { return sabotage.detected; });
  });
}

}  // namespace weft::validation
