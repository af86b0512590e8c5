#include "tests/contract/subject.hpp"

#include <weft/custom_forces/registry.hpp>

#include "tests/contract/dual/dual_laws.hpp"

namespace weft::contract {
namespace {

using forces::LawInfo;
using forces::LawSpecification;
using forces::ParameterInfo;

bool is_bounded(const ParameterInfo& parameter) {
  return parameter.maximum < ParameterInfo{}.maximum;
}

std::vector<double> typical_value(const ParameterInfo& parameter) {
  if (parameter.size == 3) return {0.4, -1.1, 0.7};
  const double span = is_bounded(parameter) ? parameter.maximum - parameter.minimum : 3.0;
  return {parameter.minimum + 0.4 * span};
}

}  // namespace

LawSpecification typical_specification(const LawInfo& info, bool with_optional) {
  LawSpecification specification{.law = std::string(info.id), .sets = {}, .parameters = {}};
  for (const ParameterInfo& parameter : info.parameters) {
    if (!parameter.required && !with_optional) continue;
    specification.parameters[std::string(parameter.name)] = typical_value(parameter);
  }
  return specification;
}

Subject registered_subject(const std::string& name, const LawSpecification& specification) {
  return {
      .name = name,
      .traits = forces::find_law(specification.law)->traits,
      .make_float = [=](const ClothMesh& m) { return forces::make_law<float>(specification, m); },
      .make_double = [=](const ClothMesh& m) { return forces::make_law<double>(specification, m); },
      .make_dual = [=](const ClothMesh& m) { return make_dual_law(specification, m); }};
}

std::vector<Subject> all_subjects() {
  std::vector<Subject> subjects;
  for (const LawInfo* info : forces::all_laws()) {
    const std::string id(info->id);
    subjects.push_back(registered_subject(id + "_required", typical_specification(*info, false)));
    const LawSpecification given = typical_specification(*info, true);
    subjects.push_back(registered_subject(id + "_given", given));
    for (const ParameterInfo& parameter : info->parameters) {
      if (parameter.size != 1) continue;
      const std::string name(parameter.name);
      LawSpecification at_end = given;
      at_end.parameters[name] = {parameter.minimum};
      subjects.push_back(registered_subject(id + "_least_" + name, at_end));
      if (!is_bounded(parameter)) continue;
      at_end.parameters[name] = {parameter.maximum};
      subjects.push_back(registered_subject(id + "_largest_" + name, at_end));
    }
  }
  return subjects;
}

std::vector<Subject> subjects_that(const std::function<bool(const forces::LawTraits&)>& claim) {
  std::vector<Subject> chosen;
  for (Subject& subject : all_subjects()) {
    if (claim(subject.traits)) chosen.push_back(std::move(subject));
  }
  return chosen;
}

}  // namespace weft::contract
