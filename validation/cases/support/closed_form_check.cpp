#include <weft/validation/cases/support/closed_form_check.hpp>

#include <cmath>

namespace weft::validation {

CheckResult judged(const CaseInfo& info, const ClosedForm& form, double measured) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = form.engine;
  check.claim = form.claim;
  check.metric = form.metric;
  check.unit = "1";
  check.formula = form.formula;
  check.source = form.source;
  check.measured = measured;
  check.tolerance = form.tolerance;
  check.verdict = judge(measured, form.tolerance);
  check.note = form.note;
  return check;
}

double relative_error(const ComparedValue& pair) {
  return std::abs(pair.value / pair.expected - 1);
}

CheckResult judged(const CaseInfo& info, const ClosedForm& form, const ComparedValue& pair) {
  CheckResult check = judged(info, form, relative_error(pair));
  check.values = {pair};
  return check;
}

void add_sabotage(CheckResult& check, const std::string& mistake, double measured) {
  check.sabotages.push_back(
      {mistake, measured, judge(measured, *check.tolerance) == Verdict::kFail});
}

}  // namespace weft::validation
